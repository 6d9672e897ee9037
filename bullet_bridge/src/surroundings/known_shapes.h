#pragma once

#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "tandem/coordination/shape.h"

namespace tandem {

/// Cache of the island's forms of a world's shapes. A hull or mesh, which takes time, is converted
/// at first use and kept while its object is in the world.
class KnownShapes {
 public:
  /// The island's form of `shape`, which is the object's shape or a child of it. Nothing for a
  /// shape that the island does not support.
  [[nodiscard]] std::optional<Shape> find(const btCollisionObject& object,
                                          const btCollisionShape& shape);

  /// Once per host step: drops shapes whose object left the world or changed its shape.
  void forgetLost(const btCollisionWorld& world);

 private:
  struct Entry {
    const btCollisionObject* object;  ///< the host may have deleted it: compare, do not read
    const btCollisionShape* whole;    ///< whole shape of the object
    const btCollisionShape* shape;
    btVector3 scaling;
    btScalar margin;
    std::optional<Shape> own;
    int place;  ///< index of the object in the world
  };
  std::vector<Entry> entries_;
};

}  // namespace tandem
