#pragma once

#include <memory>

#include "bullet_bridge/src/bodies/sphere_body.h"
#include "bullet_bridge/src/native/native_coupling.h"
#include "site/site_body.h"

namespace tandem {

/// The Bullet body of a remote user. Empty if the scheme has none.
struct Proxy {
  std::unique_ptr<SphereBody> sphere;    ///< if forces move it
  KinematicSphere* held = nullptr;       ///< if prescribed, in a native model
  SiteBody body;                         ///< island body of the sphere
  const btRigidBody* address = nullptr;  ///< of the sphere's body, also once it is deleted

  /// Null if there is none or the host has deleted it.
  [[nodiscard]] btRigidBody* findRigid() const noexcept {
    if (held) return held->isInWorld() ? &held->rigid() : nullptr;
    return sphere && sphere->isAlive() ? &sphere->rigid() : nullptr;
  }

  /// Shows it in Bullet. Bullet moves a sphere on from `state`, unless it is a ghost.
  void show(const RigidState& state, bool is_ghost) noexcept {
    btRigidBody* rigid = findRigid();
    if (!rigid) return;
    setNativeGhost(*rigid, is_ghost);
    if (!is_ghost && sphere) body.bullet->setState(state);
  }
};

}  // namespace tandem
