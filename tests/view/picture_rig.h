#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "gl/frame_target.h"
#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "gl/picture.h"
#include "view/small_meshes.h"

namespace tandem::view::test {

inline Solid makeSolid(const std::shared_ptr<const ShapeMesh>& mesh, const Vec3& p_WB,
                       const Colour& colour) {
  Solid solid;
  solid.mesh = mesh;
  solid.p_WB = p_WB;
  solid.colour = colour;
  return solid;
}

/// 1 m square, its upper side at z = 0.
inline Solid makeFloor(const Colour& colour) {
  Solid floor = makeSolid(makeBox(Vec3(0.5, 0.5, 0.01)), Vec3(0, 0, -0.01), colour);
  floor.has_grid = true;
  return floor;
}

inline int brightness(const std::array<int, 3>& pixel) {
  return (pixel[0] + pixel[1] + pixel[2]) / 3;
}

inline int countChanged(const Picture& a, const Picture& b) {
  int count = 0;
  for (int y = 0; y < a.size.height; ++y)
    for (int x = 0; x < a.size.width; ++x) count += a.at(x, y) != b.at(x, y);
  return count;
}

/// Draws without a display.
class PictureRig : public ::testing::Test {
 protected:
  Picture draw(const DrawList& list) { return draw(list, scene); }

  Picture draw(const DrawList& list, GlScene& with) const {
    const FrameTarget target(size);
    target.bind();
    with.draw(list, eye, size);
    target.bindForReading();
    return readPicture(size);
  }

  /// Pixel at which the eye sees a point, which must be in the picture.
  [[nodiscard]] std::array<int, 3> pixelAt(const Picture& picture, const Vec3& p_W) const {
    const std::optional<ProjectedPoint> seen = projectPoint(eye, picture.size, p_W);
    EXPECT_TRUE(seen);
    if (!seen) return {};
    return picture.at(static_cast<int>(std::floor(seen->point.x)),
                      static_cast<int>(std::floor(seen->point.y)));
  }

  PictureSize size = {.width = 640, .height = 400};
  Eye eye;
  HeadlessContext context;  // deleted last
  GlScene scene;
};

}  // namespace tandem::view::test
