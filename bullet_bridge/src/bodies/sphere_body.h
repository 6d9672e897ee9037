#pragma once

#include <memory>

#include "tandem/coordination/types.h"

#include "coordination/src/island/collision_filter.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

class HapticBody;

/// The bodies that a SphereBody touches natively.
enum class SphereMeets {
  kMovingBodies,  ///< passes static bodies; the island handles those
  kAllBodies,     ///< also static bodies, without friction, if there is no island
};

/// A sphere in a host's world: the Bullet body of a remote user.
///
/// It has no weight. The world must outlive it. haptic().isInWorld() tells if the host removed it
/// from its world. isAlive() tells if the host deleted it, as some do with all bodies of their
/// world.
class SphereBody {
 public:
  SphereBody(btDiscreteDynamicsWorld& world, double radius, double mass, const Vec3& p_W,
             SphereMeets meets = SphereMeets::kMovingBodies, const CollisionFilter& filter = {});
  ~SphereBody();
  SphereBody(const SphereBody&) = delete;
  SphereBody& operator=(const SphereBody&) = delete;

  [[nodiscard]] bool isAlive() const noexcept;
  /// Valid only while the body is alive.
  [[nodiscard]] btRigidBody& rigid() const noexcept;
  [[nodiscard]] HapticBody& haptic() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
