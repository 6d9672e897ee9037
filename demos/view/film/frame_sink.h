#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "gl/picture.h"

namespace tandem::view {

/// Takes the pictures of a film one by one.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// Throws Error with the reason.
  virtual void add(const Picture& picture) = 0;
  /// After the last picture. Throws Error if the film could not be stored.
  virtual void finish() = 0;
};

/// By the name's end: .mp4, .webm and .gif through the program ffmpeg, a name without an end as a
/// folder of PNG files frame_00000.png and so on. Throws UsageError for another end, Error if there
/// is no ffmpeg or the folder cannot be made.
[[nodiscard]] std::unique_ptr<FrameSink> makeFrameSink(const std::filesystem::path& out,
                                                       PictureSize size, double rate);

}  // namespace tandem::view
