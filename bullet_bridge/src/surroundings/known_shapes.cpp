#include "surroundings/known_shapes.h"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>

#include "tandem/bullet_bridge/shapes.h"

#include "world/world_lookup.h"

namespace tandem {

std::optional<Shape> KnownShapes::find(const btCollisionObject& object,
                                       const btCollisionShape& shape) {
  const int type = shape.getShapeType();
  const bool is_costly =
      type == CONVEX_HULL_SHAPE_PROXYTYPE || (shape.isConcave() && type != STATIC_PLANE_PROXYTYPE);
  if (!is_costly) return convertShape(shape);
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.shape == &shape && entry.object == &object;
  });
  if (known != entries_.end()) {
    if (known->scaling == shape.getLocalScaling() && known->margin == shape.getMargin())
      return known->own;
    entries_.erase(known);
  }
  std::optional<Shape> own = convertShape(shape);
  if (!own) own = convertMesh(shape);
  entries_.push_back({&object, object.getCollisionShape(), &shape, shape.getLocalScaling(),
                      shape.getMargin(), own, object.getWorldArrayIndex()});
  return own;
}

void KnownShapes::forgetLost(const btCollisionWorld& world) {
  std::erase_if(entries_, [&](Entry& entry) {
    entry.place = findInWorld(world, entry.object, entry.place);
    return entry.place < 0 || entry.object->getCollisionShape() != entry.whole;
  });
}

}  // namespace tandem
