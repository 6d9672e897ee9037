#pragma once

#include <vector>

#include "scene/shape_mesh.h"

namespace tandem::view {

/// Number of flat strips around a round shape.
inline constexpr int kRoundSegments = 16;

/// A point of the outline that is turned about the axis of a round shape [m].
struct OutlinePoint {
  btScalar radius = 0;  ///< from the axis, >= 0
  btScalar height = 0;  ///< along the axis
};

/// Makes the surface of a convex body of revolution that is grown by a margin [m], as Bullet does:
/// a grown point is a sphere, a grown line a capsule, and a cylinder gets round edges.
///
/// The outline goes from the lower point on the axis to the upper one. `axis` is 0, 1 or 2 for x,
/// y or z. All vertices are on the true surface, so the mesh is slightly within it.
[[nodiscard]] ShapeMesh makeRoundMesh(const std::vector<OutlinePoint>& outline, btScalar margin,
                                      int axis);

}  // namespace tandem::view
