#pragma once

#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "tandem/coordination/shape.h"

#include "surroundings/regions.h"

namespace tandem {

/// Cache of the island's forms of a world's shapes. A form that takes time (a hull, a mesh) is made
/// at first use. It is kept while its object is in the world and the shape keeps its scaling,
/// margin and bounds.
class KnownShapes {
 public:
  /// The island's form of `shape`, which is the object's shape or a child of it. Nothing for a
  /// shape that the island does not support.
  [[nodiscard]] std::optional<Shape> find(const btCollisionObject& object,
                                          const btCollisionShape& shape);

  /// The island's form of a moving object; of a compound without the parts that have none.
  [[nodiscard]] std::optional<Shape> findWhole(const btCollisionObject& object);

  /// Once per host step: drops shapes whose object left the world or changed its shape.
  void forgetLost(const btCollisionWorld& world);

 private:
  struct Entry {
    const btCollisionObject* object;  ///< the host may have deleted it: compare, do not read
    const btCollisionShape* whole;    ///< whole shape of the object
    const btCollisionShape* shape;
    btVector3 scaling;
    btScalar margin;
    Region bounds;  ///< in the shape's frame
    std::optional<Shape> own;
    int place;  ///< index of the object in the world
  };
  std::vector<Entry> entries_;
};

}  // namespace tandem
