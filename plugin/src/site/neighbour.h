#pragma once

#include <cstdint>
#include <memory>

#include "bullet_bridge/src/arms/host_arm.h"
#include "bullet_bridge/src/bodies/driven_body.h"
#include "site/site_body.h"

class btCollisionShape;

namespace tandem {

/// A moving body of the host that the island holds while it may take part in contact. The island
/// moves a dynamic one, and the host's body follows by hand-off. The host moves a kinematic one,
/// and the island's body follows it. The links of a multi-body fill a slot each.
struct Neighbour {
  btRigidBody* rigid = nullptr;                        ///< null: a link, or the slot is empty
  LinkBody* link = nullptr;                            ///< owned by its HostArm
  btCollisionObject* object = nullptr;                 ///< with its shape; null: it has none
  const btCollisionShape* shape = nullptr;             ///< at its entry
  std::uint64_t parts = 0;                             ///< lookAtParts() at its entry
  IslandBody settings;                                 ///< island body in the slot
  std::unique_ptr<HapticBody> bullet;                  ///< if dynamic; `body` points to it, or link
  std::unique_ptr<DrivenBody> driven;                  ///< if kinematic
  double linear_damping = 0.0, angular_damping = 0.0;  ///< Bullet's factors, as last read
  SiteBody body;
  Momentum owed;        ///< momentum it still gets when it goes back
  bool is_new = false;  ///< promoted, but not in the island yet

  [[nodiscard]] bool isEmpty() const noexcept { return !rigid && !link; }
  [[nodiscard]] bool isInWorld() const noexcept {
    return body.bullet ? body.bullet->isInWorld() : driven->isInWorld();
  }
  /// The host has moved all of its world by `offset_W` [m].
  void shiftOrigin(const Vec3& offset_W) noexcept {
    body.shiftOrigin(offset_W);
    settings.start.p_W += offset_W;
    if (driven) driven->shiftOrigin(offset_W);
  }
  /// Empties the slot for another body.
  void becomeEmpty();
  /// True if the host changed it, or made another body at its address. It must be in its world.
  [[nodiscard]] bool hasChanged() const noexcept;
  /// Updates the damping of the island's body to the values last read. True if it changed.
  bool followDamping() noexcept;
  /// Reads Bullet's damping, in the host's thread.
  void lookAtDamping() noexcept;
};

}  // namespace tandem
