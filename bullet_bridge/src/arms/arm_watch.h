#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <LinearMath/btVector3.h>

#include "bodies/collider_look.h"

class btDiscreteDynamicsWorld;
class btMultiBody;
class btMultiBodyDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// The world as one that may have multi-bodies; null: it cannot.
[[nodiscard]] btMultiBodyDynamicsWorld* asMultiBodyWorld(btDiscreteDynamicsWorld& world) noexcept;

/// The multi-body of a link's collider, if it is one.
[[nodiscard]] btMultiBody* multiBodyOf(const btCollisionObject& object) noexcept;

/// True for the collider of a fixed base, or of a link that is fixed to it: it never moves.
[[nodiscard]] bool isGround(const btCollisionObject& object) noexcept;
/// The same for a link without a collider, too; -1: the base.
[[nodiscard]] bool isGround(const btMultiBody& body, int link) noexcept;

/// True if the world has the multi-body and all of its colliders. Compares addresses first: it may
/// have been deleted. False while the world is destroyed: its multi-bodies go before all else.
[[nodiscard]] bool hasMultiBody(btDiscreteDynamicsWorld& world, const btMultiBody* body) noexcept;

/// Why the island cannot hold a multi-body of the world, as the end of a sentence; null: it can.
[[nodiscard]] const char* findObstacleToHold(btMultiBodyDynamicsWorld& world,
                                             btMultiBody& body) noexcept;

/// Properties of a multi-body that the island reads once, when it takes it. A difference means that
/// the host changed it, or made another one at its address.
class ArmLook {
 public:
  /// Allocates.
  explicit ArmLook(const btMultiBody& body);
  /// Real-time safe. The multi-body must be in its world.
  [[nodiscard]] bool isOf(const btMultiBody& body) const noexcept;

 private:
  struct Link {
    const btCollisionObject* collider = nullptr;
    ColliderLook look;  ///< of the collider
    btScalar mass = 0;
    btVector3 inertia{0, 0, 0};
  };
  [[nodiscard]] static Link look(const btMultiBody& body, int link) noexcept;

  std::vector<Link> links_;  ///< the base first
  bool is_fixed_;
};

}  // namespace tandem
#pragma GCC visibility pop
