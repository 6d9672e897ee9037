#pragma once

#include <filesystem>
#include <optional>

#include "gl/projection.h"
#include "peer/peer_line.h"

namespace tandem::view {

/// A user's wishes for any window, from the command line.
struct WindowSettings {
  PictureSize size{1280, 800};                      ///< [pixel]
  std::optional<double> duration;                   ///< closes itself after this time [s]
  std::optional<std::filesystem::path> status;      ///< file of a JSON line every 0.1 s
  std::optional<std::filesystem::path> screenshot;  ///< PNG of the last frame
};

/// A user's wishes for a window on a live session.
struct ViewSettings {
  WindowSettings window;
  demos::Scenario scenario;
  std::optional<demos::PeerLine> line;          ///< to the other site; none: both are here
  std::optional<std::filesystem::path> record;  ///< folder for a record of each session
};

}  // namespace tandem::view
