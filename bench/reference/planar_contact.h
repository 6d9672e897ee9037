#pragma once

#include <array>

#include "bench/reference/planar_scene.h"

namespace tandem::demos::bench {

/// A point where two bodies touch or are about to.
struct PlanarPoint {
  Vec2 p = Vec2::Zero();  ///< midway between the surfaces [m]
  double gap = 0.0;       ///< negative: overlap [m]
  int feature = 0;        ///< stays equal between steps for one corner on one face
};

/// Contact of two bodies: at most two points with one normal.
struct PlanarManifold {
  Vec2 normal = Vec2::UnitY();  ///< points from the first body to the second
  std::array<PlanarPoint, 2> points;
  int count = 0;
};

/// Contact of two rigid bodies, with gaps up to `reach`. Boxes use separating axes and clipped
/// faces. For corner on corner, the normal is that of the face with the least overlap.
[[nodiscard]] PlanarManifold computeManifold(const PlanarBody& a, const PlanarBody& b,
                                             double reach);

/// Contact of a circle with a body: overlap, normal from the body to the circle, nearest surface
/// point.
struct PlanarTouch {
  double overlap = 0.0;
  Vec2 normal = Vec2::UnitX();
  Vec2 point = Vec2::Zero();
};
[[nodiscard]] PlanarTouch computePlanarTouch(const PlanarBody& body, const Vec2& centre,
                                             double radius);

}  // namespace tandem::demos::bench
