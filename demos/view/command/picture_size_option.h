#pragma once

#include <cstdio>
#include <string>

#include <fmt/format.h>

#include "gl/projection.h"
#include "terminal/usage_error.h"

namespace tandem::view {

/// Size of a picture as written, such as 1280x800. Even numbers, which video wants. Throws
/// UsageError.
[[nodiscard]] inline PictureSize parsePictureSize(const std::string& text) {
  PictureSize size;
  char rest = 0;
  const int read = std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest);
  const auto fits = [](int pixels) { return pixels >= 64 && pixels <= 4096 && pixels % 2 == 0; };
  if (read != 2 || !fits(size.width) || !fits(size.height))
    throw demos::UsageError(fmt::format(
        "--size {}: must be WIDTHxHEIGHT, even numbers from 64 to 4096, e.g. 1280x800", text));
  return size;
}

}  // namespace tandem::view
