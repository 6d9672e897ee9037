#pragma once

#include <memory>

#include "tandem/coordination/shape.h"
#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// A body to be made in an OwnWorld.
struct OwnBodySettings {
  Shape shape = Box{Vec3::Constant(0.02)};  ///< any but a Mesh; a Plane is static
  double mass = 0.2;                        ///< [kg]; 0: static
  Vec3 inertia = Vec3::Zero();  ///< principal moments [kg m^2]; all 0: as Bullet takes them for the
                                ///< shape, of a box around capsules and hulls
  double friction = 0.5;
  double restitution = 0.0;
  RigidState start;
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkOwnBodySettings(const OwnBodySettings& settings);

/// A Bullet world with all that belongs to it, for a host that has none of its own. Without gravity
/// and bodies at first. One thread steps it; worlds may live in different threads.
class OwnWorld {
 public:
  OwnWorld();
  ~OwnWorld();
  OwnWorld(const OwnWorld&) = delete;
  OwnWorld& operator=(const OwnWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() const noexcept;

  /// The body lives until remove(), or as long as the world. Without built-in damping. Throws
  /// std::invalid_argument as checkOwnBodySettings().
  btRigidBody& add(const OwnBodySettings& settings);

  /// A body of add() that no Site shares.
  void remove(btRigidBody& body) noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
