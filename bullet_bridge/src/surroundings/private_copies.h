#pragma once

#include <memory>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "coordination/src/island/contact_finder.h"
#include "surroundings/regions.h"

class btStaticPlaneShape;

namespace tandem {

/// How an object's surface is, and what its owner knows it by.
struct Surface {
  btScalar friction = 0, rolling_friction = 0, spinning_friction = 0, restitution = 0;
  void* user_pointer = nullptr;
  int user_index = -1, user_index2 = -1, user_index3 = -1;

  [[nodiscard]] static Surface of(const btCollisionObject& object) noexcept;
  void applyTo(btCollisionObject& object) const noexcept;
  bool operator==(const Surface&) const noexcept = default;
};

/// An object of the host's world as the private contact search has it: same shape and surface, at a
/// place of its own.
struct PrivateCopy {
  /// `index`: of the island's body, or kStanding.
  PrivateCopy(btCollisionObject& host_object, BodyIndex index);

  /// Where a standing original is, seen from `origin_W`.
  [[nodiscard]] btTransform findOriginal(const Vec3& origin_W) const;
  void place(const btTransform& pose);

  btCollisionObject* original;         ///< the host may have deleted it: compare, do not read
  const btCollisionShape* host_shape;  ///< another one: another object at the same address
  BodyIndex index;
  std::unique_ptr<btCollisionShape> own_shape;  ///< null: the host's is shared
  const btStaticPlaneShape* plane = nullptr;    ///< own_shape of a plane: through its origin
  btScalar skin = 0;  ///< by which own_shape is larger all round than the host's [m]
  btCollisionObject object;
  int world_index = -1;          ///< of the original in the host's world, last time
  Vec3 p_placed = Vec3::Zero();  ///< of a body: where it was placed last, from the private origin
  Quat q_placed = Quat::Identity();
  Region bounds;  ///< around the copy where it was placed last
};

}  // namespace tandem
