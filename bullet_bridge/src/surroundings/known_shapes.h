#pragma once

#include <optional>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "tandem/coordination/shape.h"

namespace tandem {

/// The island's own forms of the shapes of a world's objects. A hull or a mesh, which takes time,
/// is made when it is first asked for and kept while its object is in the world.
class KnownShapes {
 public:
  /// Nothing for a shape that the island does not know. `shape` is that of the object, or a child
  /// of it.
  [[nodiscard]] std::optional<Shape> find(const btCollisionObject& object,
                                          const btCollisionShape& shape);

  /// Once per host step: drops those whose object has left the world, or has another shape now.
  void forgetLost(const btCollisionWorld& world);

 private:
  struct Entry {
    const btCollisionObject* object;  ///< the host may have deleted it: compare, do not read
    const btCollisionShape* whole;    ///< of the object
    const btCollisionShape* shape;
    btVector3 scaling;
    btScalar margin;
    std::optional<Shape> own;
    int place;  ///< of the object in the world
  };
  std::vector<Entry> entries_;
};

}  // namespace tandem
