#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gl/projection.h"

namespace tandem::view {

/// Pixels of a frame, from the upper left, row by row.
struct Picture {
  PictureSize size;
  std::vector<std::uint8_t> rgba;  ///< red, green, blue (sRGB) and 255 of each pixel

  /// Red, green and blue of a pixel, which must be in the picture.
  [[nodiscard]] std::array<int, 3> at(int x, int y) const;
};

/// Reads what has been drawn into the framebuffer that is bound for reading. Waits for the drawing
/// to end. Throws Error if the driver fails.
[[nodiscard]] Picture readPicture(PictureSize size);

/// Stores a picture as PNG. The file is there whole or as it was before. On failure gives one line
/// that says what failed, nothing otherwise.
[[nodiscard]] std::optional<std::string> writePng(const Picture& picture,
                                                  const std::filesystem::path& file);

}  // namespace tandem::view
