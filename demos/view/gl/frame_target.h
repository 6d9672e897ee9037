#pragma once

#include "gl/gl_object.h"
#include "gl/projection.h"

namespace tandem::view {

/// A picture in memory to draw into, for use without a window. Needs a current context, also when
/// it is deleted.
class FrameTarget {
 public:
  /// `samples` of 4 smooths edges and takes about four times as long: for stills. Throws Error if
  /// the driver cannot make a picture of that size.
  explicit FrameTarget(PictureSize size, int samples = 1);

  /// Makes drawing go here.
  void bind() const;
  /// Makes the finished picture what readPicture() reads.
  void bindForReading() const;
  [[nodiscard]] PictureSize size() const noexcept { return size_; }

 private:
  PictureSize size_;
  GlRenderbuffer colour_, depth_;
  GlFramebuffer frame_;
  // One sample for each pixel, to read from; not made if the frame itself is so.
  GlRenderbuffer plain_colour_;
  GlFramebuffer plain_frame_;
};

}  // namespace tandem::view
