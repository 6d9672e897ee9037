#pragma once

#include <filesystem>
#include <functional>

#include "gl/projection.h"
#include "scenario/scenario.h"

namespace tandem::view {

class RunReplay;

/// A user's wishes for a film, from the command line.
struct FilmSettings {
  std::filesystem::path out;
  PictureSize size{960, 600};  ///< [pixel]
  double rate = 30.0;          ///< pictures for each second, at most 30 [Hz]
};

/// Runs a scenario in virtual time and draws it without a display, so that no machine makes the
/// film stutter. Equal inputs give equal pictures. Calls `progress` with the finished share. Throws
/// UsageError for bad input, Error for the rest.
void makeFilm(const demos::Scenario& scenario, const FilmSettings& settings,
              const std::function<void(double)>& progress);

/// The same of a recorded run, whose pictures are those that were recorded.
void makeFilm(RunReplay& replay, const FilmSettings& settings,
              const std::function<void(double)>& progress);

}  // namespace tandem::view
