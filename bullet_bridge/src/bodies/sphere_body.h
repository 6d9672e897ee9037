#pragma once

#include <memory>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

class HapticBody;

/// What a SphereBody meets natively.
enum class SphereMeets {
  kMovingBodies,  ///< it passes static ones: those the island keeps it out of
  kAllBodies,     ///< static ones, too, and without friction: there is no island to do it
};

/// A sphere that is put into a host's world and taken out again: the Bullet body of a remote user.
///
/// It has no weight. The world must outlive it. A host that takes it out of its world is noticed by
/// haptic().isInWorld(), one that deletes it, too, as hosts do that delete all there is in their
/// world, by isAlive().
class SphereBody {
 public:
  SphereBody(btDiscreteDynamicsWorld& world, double radius, double mass, const Vec3& p_W,
             SphereMeets meets = SphereMeets::kMovingBodies);
  ~SphereBody();
  SphereBody(const SphereBody&) = delete;
  SphereBody& operator=(const SphereBody&) = delete;

  [[nodiscard]] bool isAlive() const noexcept;
  /// While it is alive.
  [[nodiscard]] btRigidBody& rigid() const noexcept;
  [[nodiscard]] HapticBody& haptic() const noexcept;

  /// A ghost passes all bodies: Bullet sees its contacts and does not act on them. Real-time safe.
  void setGhost(bool is_ghost) noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
