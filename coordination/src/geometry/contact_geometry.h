#pragma once

#include "tandem/coordination/shape.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Where a sphere and another shape are nearest to each other (or deepest in each other).
struct SphereContact {
  double gap = 0.0;          ///< distance of the surfaces [m]; negative: overlap
  Vec3 n_W = Vec3::UnitX();  ///< unit normal, from the other shape towards the sphere
  Vec3 p_W = Vec3::Zero();   ///< nearest point on the other shape's surface [m]
};

/// Nearest points of a sphere (centre `p_W`, `radius`) and a shape whose body frame B stands at
/// `p_WB`, `q_WB`. Always answers, whether they overlap or not, so that the caller can watch the
/// gap close. The force on the sphere acts along +n_W at p_W, its reaction on the other body along
/// -n_W at the same point; the line of both passes through the sphere's centre.
///
/// To a mesh as a whole: the nearest of its points that push, see TriangleMesh; one that pushes by
/// two sides of a groove is nearest to one of them. Behind an open mesh, an infinite gap.
///
/// A centre inside a box, cylinder or hull leaves by the nearest face; exactly in the middle of
/// two, by the first in the order x, y, z and + before -. A centre on a capsule's or sphere's core
/// leaves along a fixed body direction. Pure; real-time safe; deterministic; gap is continuous in
/// all arguments, n_W is unit length always.
[[nodiscard]] SphereContact findSphereContact(const Vec3& p_W, double radius, const Shape& shape,
                                              const Vec3& p_WB, const Quat& q_WB) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
