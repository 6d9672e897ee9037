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
};

/// Runs a scenario in virtual time and draws it without a display, 30 pictures for each of its
/// seconds, so that no machine makes the film stutter. Equal inputs give equal pictures. Calls
/// `progress` with the finished share. Throws UsageError for bad input, Error for the rest.
void makeFilm(const demos::Scenario& scenario, const FilmSettings& settings,
              const std::function<void(double)>& progress);

/// The same of a recorded run, with a picture for each that was recorded.
void makeFilm(RunReplay& replay, const FilmSettings& settings,
              const std::function<void(double)>& progress);

}  // namespace tandem::view
