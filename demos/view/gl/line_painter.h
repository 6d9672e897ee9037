#pragma once

#include <vector>

#include "gl/gl_object.h"
#include "gl/projection.h"

namespace tandem::view {

/// Draws lines of any width: a core profile has no wide ones of its own.
class LinePainter {
 public:
  LinePainter();

  /// Draws into the bound framebuffer of that size. What is solid hides lines behind it; among
  /// lines, later ones cover earlier ones. Lines with numbers that are not finite are left out.
  void draw(const std::vector<Line>& lines, const Eye& eye, PictureSize size);

 private:
  GlProgram program_;
  GlVertexArray array_;
  GlBuffer instances_;
};

}  // namespace tandem::view
