#pragma once

#include <memory>

#include "bullet_bridge/src/bodies/driven_body.h"
#include "site/site_body.h"

class btCollisionShape;

namespace tandem {

/// A moving body of the host that the island holds while it may take part in contact. The island
/// moves a dynamic one, and the host's body follows by hand-off. The host moves a kinematic one,
/// and the island's body goes where it is going.
struct Neighbour {
  btRigidBody* rigid = nullptr;                        ///< null: the slot is empty
  const btCollisionShape* shape = nullptr;             ///< that it came with
  IslandBody settings;                                 ///< of the slot
  std::unique_ptr<HapticBody> bullet;                  ///< of a dynamic one: what `body` points to
  std::unique_ptr<DrivenBody> driven;                  ///< of a kinematic one
  double linear_damping = 0.0, angular_damping = 0.0;  ///< as Bullet understands it, seen last
  SiteBody body;
  Momentum owed;        ///< with which it goes back
  bool is_new = false;  ///< promoted, but not in the island yet

  [[nodiscard]] bool isInWorld() const noexcept {
    return bullet ? bullet->isInWorld() : driven->isInWorld();
  }
  /// The slot is free again.
  void becomeEmpty();
  /// True if the host has made it another body: its shape, its mass, or who moves it.
  [[nodiscard]] bool hasChanged() const noexcept;
  /// Damping of the island's body as the host has it now. True if it has changed.
  bool followDamping() noexcept;
  /// The host's thread reads the damping.
  void lookAtDamping() noexcept;
};

}  // namespace tandem
