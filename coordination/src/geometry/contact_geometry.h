#pragma once

#include "tandem/coordination/shape.h"

#pragma GCC visibility push(default)
namespace tandem {

/// The nearest points of a sphere and another shape, or the deepest if they overlap.
struct SphereContact {
  double gap = 0.0;          ///< distance of the surfaces [m]; negative: overlap
  Vec3 n_W = Vec3::UnitX();  ///< unit normal, from the other shape towards the sphere
  Vec3 p_W = Vec3::Zero();   ///< nearest point on the other shape's surface [m]
  int under = -1;            ///< face under the centre: Separation::under
};

/// Nearest points of a sphere (centre `p_W`, `radius`) and a shape whose body frame B is at `p_WB`,
/// `q_WB`. The result is valid with or without overlap, so the caller can watch the gap close. The
/// force on the sphere acts along +n_W at p_W, its reaction on the other body along -n_W at the
/// same point. The line of both passes through the sphere's centre.
///
/// For a whole mesh: the nearest point that pushes, see TriangleMesh. A sphere pushed by both sides
/// of a groove gets the nearer one. Behind an open mesh the gap is infinite.
///
/// A centre inside a box, cylinder, cone or hull leaves through the nearest face. Ties go to the
/// first in the order x, y, z and + before -. A centre on a capsule's or sphere's core leaves along
/// a fixed body direction. Pure; real-time safe; deterministic. The gap is continuous in all
/// arguments; n_W always has unit length.
///
/// `touched`: face that the sphere has touched (Separation::under), or -1; see held_face.h. Not for
/// a mesh.
[[nodiscard]] SphereContact findSphereContact(const Vec3& p_W, double radius, const Shape& shape,
                                              const Vec3& p_WB, const Quat& q_WB,
                                              int touched = -1) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
