#pragma once

#include <memory>

#include "bullet_bridge/src/bodies/sphere_body.h"
#include "bullet_bridge/src/native/native_coupling.h"
#include "site/site_body.h"

namespace tandem {

/// The Bullet body of a remote user. Empty where the scheme has none.
struct Proxy {
  std::unique_ptr<SphereBody> sphere;  ///< moved by forces
  KinematicSphere* held = nullptr;     ///< in its place in a native model, if it is what it is told
  SiteBody body;                       ///< of the sphere

  /// Null where there is none, and where the host has deleted it.
  [[nodiscard]] btRigidBody* findRigid() const noexcept {
    if (held) return held->isInWorld() ? &held->rigid() : nullptr;
    return sphere && sphere->isAlive() ? &sphere->rigid() : nullptr;
  }
};

}  // namespace tandem
