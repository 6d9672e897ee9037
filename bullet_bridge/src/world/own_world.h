#pragma once

#include <memory>

#include "tandem/coordination/shape.h"
#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// Settings of a body in an OwnWorld.
struct OwnBodySettings {
  Shape shape = Box{Vec3::Constant(0.02)};  ///< any shape except Mesh; a Plane is static
  double mass = 0.2;                        ///< [kg]; 0: static
  Vec3 inertia = Vec3::Zero();  ///< [kg m^2]; all 0: Bullet's (capsules and hulls: of a box)
  double friction = 0.5;
  double restitution = 0.0;
  double rolling_friction = 0.0, spinning_friction = 0.0;  ///< greatest torque per force [m]
  RigidState start;
};

/// Throws std::invalid_argument, naming the value and what is allowed.
void checkOwnBodySettings(const OwnBodySettings& settings);

/// A complete Bullet world for a host without one. It starts without gravity and bodies. One thread
/// steps it; worlds may live in different threads.
class OwnWorld {
 public:
  OwnWorld();
  ~OwnWorld();
  OwnWorld(const OwnWorld&) = delete;
  OwnWorld& operator=(const OwnWorld&) = delete;

  [[nodiscard]] btDiscreteDynamicsWorld& world() const noexcept;

  /// Adds a body without built-in damping. It lives until remove(), or as long as the world. Throws
  /// std::invalid_argument like checkOwnBodySettings().
  btRigidBody& add(const OwnBodySettings& settings);

  /// Gives a body of add() the mass, inertia and surface of `settings`; shape and state stay. A
  /// Site that shares it takes its share of the mass in the next step. Throws std::invalid_argument
  /// like checkOwnBodySettings(), and if a moving body would become static or the reverse.
  void change(btRigidBody& body, const OwnBodySettings& settings);

  /// Removes a body of add(), which no Site may share.
  void remove(btRigidBody& body) noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
