#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gl/projection.h"
#include "peer/peer_line.h"

namespace tandem::view {

/// What the user asks of a window on the command line.
struct ViewSettings {
  std::filesystem::path scenario;
  std::vector<std::string> overrides;               ///< "key=value"
  std::optional<demos::PeerLine> line;              ///< to the other site; none: both are here
  PictureSize size{1280, 800};                      ///< [pixel]
  std::optional<double> duration;                   ///< closes itself after this time [s]
  std::optional<std::filesystem::path> status;      ///< file of a JSON line every 0.1 s
  std::optional<std::filesystem::path> screenshot;  ///< PNG of the last frame
};

}  // namespace tandem::view
