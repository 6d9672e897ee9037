#pragma once

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

namespace tandem {

/// True for a compound of either kind, also an empty one.
[[nodiscard]] inline bool hasChildren(const btCollisionShape& shape) {
  if (shape.isCompound()) return true;
  return shape.getShapeType() == GIMPACT_SHAPE_PROXYTYPE &&
         static_cast<const btGImpactShapeInterface&>(shape).getGImpactShapeType() ==
             CONST_GIMPACT_COMPOUND_SHAPE;
}

/// Calls `visit(child, pose)` for each child of a compound.
template <typename Visit>
void forEachChild(const btCollisionShape& shape, const Visit& visit) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      visit(*compound.getChildShape(i), compound.getChildTransform(i));
    return;
  }
  const auto& gimpact = static_cast<const btGImpactShapeInterface&>(shape);
  const bool has_poses = gimpact.childrenHasTransform();
  for (int i = 0; i < gimpact.getNumChildShapes(); ++i)
    visit(*gimpact.getChildShape(i),
          has_poses ? gimpact.getChildTransform(i) : btTransform::getIdentity());
}

/// Calls `visit(shape, pose)` for each shape in nested compounds, or for the shape itself.
template <typename Visit>
void forEachLeaf(const btCollisionShape& shape, const btTransform& pose, const Visit& visit) {
  if (!hasChildren(shape)) return visit(shape, pose);
  forEachChild(shape, [&](const btCollisionShape& child, const btTransform& child_pose) {
    forEachLeaf(child, pose * child_pose, visit);
  });
}

}  // namespace tandem
