#pragma once

#include <memory>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "coordination/src/island/contact_finder.h"
#include "surroundings/regions.h"

class btStaticPlaneShape;

namespace tandem {

/// Surface properties of an object, and its owner's user data.
struct Surface {
  btScalar friction = 0, rolling_friction = 0, spinning_friction = 0, restitution = 0;
  void* user_pointer = nullptr;
  int user_index = -1, user_index2 = -1, user_index3 = -1;

  [[nodiscard]] static Surface of(const btCollisionObject& object) noexcept;
  void applyTo(btCollisionObject& object) const noexcept;
  bool operator==(const Surface&) const noexcept = default;
};

/// Private copy of a host's object for the contact search: same shape and surface, own pose.
struct PrivateCopy {
  /// `index`: the island body, or kStanding.
  PrivateCopy(btCollisionObject& host_object, BodyIndex index);

  /// Pose of a standing original relative to `origin_W`.
  [[nodiscard]] btTransform findOriginal(const Vec3& origin_W) const;
  void place(const btTransform& pose);

  btCollisionObject* original;         ///< the host may have deleted it: compare, do not read
  const btCollisionShape* host_shape;  ///< a change means another object at the same address
  BodyIndex index;
  std::unique_ptr<btCollisionShape> own_shape;  ///< null: shared with the host
  const btStaticPlaneShape* plane = nullptr;    ///< own_shape if it is a plane, through its origin
  btScalar skin = 0;  ///< excess of own_shape over the host's shape, all round [m]
  btCollisionObject object;
  int world_index = -1;          ///< last index of the original in the host's world
  Vec3 p_placed = Vec3::Zero();  ///< last position of a body, from the private origin [m]
  Quat q_placed = Quat::Identity();
  Region bounds;  ///< box around the copy at its last pose
};

}  // namespace tandem
