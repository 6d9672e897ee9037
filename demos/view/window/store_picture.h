#pragma once

#include <cstdio>

#include <fmt/format.h>

#include "gl/picture.h"

namespace tandem::view {

/// Where the user's picture goes, in the current folder.
inline constexpr const char* kPictureName = "tandem-view.png";

/// Stores what the window shows as PNG. A failure is said on stderr, and the window goes on.
inline void storePicture(PictureSize size, const std::filesystem::path& file) {
  if (const auto problem = writePng(readPicture(size), file))
    fmt::print(stderr, "tandem: {}\n", *problem);
}

}  // namespace tandem::view
