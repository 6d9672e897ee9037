#pragma once

#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/falcon/pointer_plane.h"

#include "scene/draw_list.h"

namespace tandem::view {

using Mat4 = Eigen::Matrix4d;

/// The size of a picture or of a window's content [pixel].
struct PictureSize {
  int width = 0, height = 0;

  [[nodiscard]] bool isEmpty() const noexcept { return width <= 0 || height <= 0; }
  [[nodiscard]] double aspect() const noexcept {
    return static_cast<double>(width) / static_cast<double>(height);
  }
};

/// A point of a picture, as a mouse reports it: x to the right, y down, from the upper left corner
/// [pixel]. The first pixel's centre is (0.5, 0.5).
struct PicturePoint {
  double x = 0.0, y = 0.0;
};

/// A point of the world where the picture shows it.
struct ProjectedPoint {
  PicturePoint point;
  double depth = 0.0;  ///< before the eye, along its axis [m]
};

/// Directions of a picture in W, unit vectors: to its right, to its top, and out of it to the eye.
struct EyeAxes {
  Vec3 right_W, up_W, back_W;
};
[[nodiscard]] EyeAxes computeEyeAxes(const Eye& eye);

/// The eye in W [m].
[[nodiscard]] Vec3 computeEyePosition(const Eye& eye);

/// Takes points in W to the eye's frame, in which x is right, y up and z out of the picture [m].
[[nodiscard]] Mat4 computeViewMatrix(const Eye& eye);

/// Takes points in the eye's frame to OpenGL's clip space. The size must not be empty. The picture
/// shows depths from 2 % of the eye's distance to 50 distances and 10 m.
[[nodiscard]] Mat4 computeProjectionMatrix(const Eye& eye, PictureSize size);

/// The nearest depth that a picture shows; lines are cut there [m].
[[nodiscard]] double nearestDepth(const Eye& eye);

/// Both: takes points in W to clip space.
[[nodiscard]] Mat4 computeWorldToClip(const Eye& eye, PictureSize size);

/// Ray through a point of the picture; also through points beyond its edges. None for an empty
/// picture or numbers that are not finite.
[[nodiscard]] std::optional<PointerRay> computeRay(const Eye& eye, PictureSize size,
                                                   PicturePoint point);

/// Where the picture shows a point of the world; perhaps beyond its edges. None for a point before
/// the nearest depth, an empty picture or numbers that are not finite.
[[nodiscard]] std::optional<ProjectedPoint> projectPoint(const Eye& eye, PictureSize size,
                                                         const Vec3& p_W);

/// True if all numbers are finite and the eye has a distance and a field of view.
[[nodiscard]] bool isUsable(const Eye& eye) noexcept;

}  // namespace tandem::view
