#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/shape.h"

#include "coordination/src/geometry/compound_parts.h"
#include "shapes/compound_children.h"
#include "shapes/only_shape.h"

namespace tandem {

/// The island's form of a moving body's shape.
struct MovingForm {
  std::optional<Shape> shape;                 ///< nothing: the hand cannot feel it
  const btCollisionShape* unknown = nullptr;  ///< first part that has no form; the rest has one
};

/// Form of a shape, of compounds by their parts. `find(part)` gives the form of a part, which is no
/// compound. Parts without any surface count as none; planes are for standing bodies only.
template <typename Find>
MovingForm makeMovingForm(const btCollisionShape& shape, Find find) {
  MovingForm form;
  std::vector<ShapePart> parts;
  const btCollisionShape& only = onlyShapeOf(shape);
  forEachLeaf(
      only, btTransform::getIdentity(), [&](const btCollisionShape& part, const btTransform& pose) {
        if (part.getShapeType() == EMPTY_SHAPE_PROXYTYPE) return;
        std::optional<Shape> own = find(part);
        if (own && !std::holds_alternative<Plane>(*own))
          parts.push_back(
              {*std::move(own), fromBullet(pose.getOrigin()), fromBullet(pose.getRotation())});
        else if (!form.unknown)
          form.unknown = &part;
      });
  if (!parts.empty())
    form.shape = hasChildren(only) ? Shape(makeCompound(parts)) : parts.front().shape;
  return form;
}

}  // namespace tandem
