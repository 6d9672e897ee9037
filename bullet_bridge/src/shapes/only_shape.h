#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

namespace tandem {

/// Entries of a child's pose may differ from none by so much [m, and parts of a unit vector].
constexpr btScalar kNoPose = btScalar(1e-6);

/// What a shape is: of a compound with one child at its origin that child, else the shape itself.
/// Some hosts wrap every shape so.
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
