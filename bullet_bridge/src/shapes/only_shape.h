#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

namespace tandem {

/// Tolerance of a child's pose against identity [m, and shares of a unit vector].
constexpr btScalar kNoPose = btScalar(1e-6);

/// The child of a compound that has one child at its origin, else the shape itself. Some hosts wrap
/// every shape in such a compound.
[[nodiscard]] inline const btCollisionShape& onlyShapeOf(const btCollisionShape& shape) {
  if (shape.getShapeType() != COMPOUND_SHAPE_PROXYTYPE) return shape;
  const auto& compound = static_cast<const btCompoundShape&>(shape);
  if (compound.getNumChildShapes() != 1) return shape;
  const btTransform& pose = compound.getChildTransform(0);
  const btMatrix3x3& none = btMatrix3x3::getIdentity();
  for (int i = 0; i < 3; ++i) {
    const btVector3 turned = (pose.getBasis()[i] - none[i]).absolute();
    if (btFabs(pose.getOrigin()[i]) > kNoPose || turned[turned.maxAxis()] > kNoPose) return shape;
  }
  return onlyShapeOf(*compound.getChildShape(0));
}

}  // namespace tandem
