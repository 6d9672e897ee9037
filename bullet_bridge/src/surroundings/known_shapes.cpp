#include "surroundings/known_shapes.h"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "tandem/bullet_bridge/shapes.h"

#include "shapes/compound_form.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

/// Shapes whose form takes a copy of some numbers.
bool isCheap(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
    case BOX_2D_SHAPE_PROXYTYPE:
    case SPHERE_SHAPE_PROXYTYPE:
    case CAPSULE_SHAPE_PROXYTYPE:
    case CONE_SHAPE_PROXYTYPE:
    case CYLINDER_SHAPE_PROXYTYPE:
    case STATIC_PLANE_PROXYTYPE:
      return true;
    default:
      return false;
  }
}

}  // namespace

std::optional<Shape> KnownShapes::find(const btCollisionObject& object,
                                       const btCollisionShape& shape) {
  if (isCheap(shape)) return convertShape(shape);
  const Region bounds = computeRegion(shape, btTransform::getIdentity());
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.shape == &shape && entry.object == &object;
  });
  if (known != entries_.end()) {
    if (equalBits(known->scaling, shape.getLocalScaling()) && known->margin == shape.getMargin() &&
        known->bounds == bounds)
      return known->own;
    entries_.erase(known);
  }
  std::optional<Shape> own = findForm(shape);
  entries_.push_back({&object, object.getCollisionShape(), &shape, shape.getLocalScaling(),
                      shape.getMargin(), bounds, own, object.getWorldArrayIndex()});
  return own;
}

std::optional<Shape> KnownShapes::findWhole(const btCollisionObject& object) {
  return makeMovingForm(*object.getCollisionShape(),
                        [&](const btCollisionShape& part) { return find(object, part); })
      .shape;
}

void KnownShapes::forgetLost(const btCollisionWorld& world) {
  std::erase_if(entries_, [&](Entry& entry) {
    entry.place = findInWorld(world, entry.object, entry.place);
    return entry.place < 0 || entry.object->getCollisionShape() != entry.whole;
  });
}

}  // namespace tandem
