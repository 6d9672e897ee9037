#pragma once

#include <memory>
#include <vector>

#include "tandem/coordination/island.h"
#include "tandem/coordination/rigid_contacts.h"

class btCollisionObject;
class btDiscreteDynamicsWorld;
class btRigidBody;

namespace tandem {

/// The static objects of a host's world, for the island: found near the haptic bodies once per host
/// step, copied into a private Bullet world, and solved against there at the island's inner step.
///
/// The private world is Bullet's narrowphase and solver with copies of the island's rigid bodies
/// and of the static objects; there is no broadphase, as the candidates are few, and bodies do not
/// meet each other. Its origin is near the first body, so that a float Bullet resolves tens of
/// nanometres anywhere; states stay in double, only what contact changes is taken from Bullet.
/// There is no gravity (the island's prediction has it) and no bounce at restitution 0: overlap is
/// pushed out apart from the velocity, at 0.25 m/s at most.
///
/// Friction, restitution, rolling friction, linear and angular factors, mass, inertia, shapes and
/// margins are those of the host's objects (of bodies: as they are at addBody(), so scale the mass
/// first). Contact stiffness is not used. The host's btCollisionShapes are shared: they must not
/// change while attached, and must live until the update() after their object has left the world.
/// Native contact between an island body and a candidate is filtered in the host's world while it
/// is a candidate. Kinematic objects and moving bodies are no candidates. Bullet's global contact
/// callbacks see the copies, too; they carry their originals' user pointers.
///
/// Not thread safe: all functions in the thread that steps the host's world. Compound shapes make
/// Bullet allocate in every solve; all others only at first touch.
class Obstacles final : public RigidContacts {
 public:
  /// `host` must outlive this object, bodies too unless they have left the world.
  explicit Obstacles(btDiscreteDynamicsWorld& host);
  ~Obstacles() override;

  /// Set-up. The island body `index` is `body` of the host's world; it will be held by obstacles.
  /// Throws tandem::Error if the index has a body already, or the body is not dynamic or not of a
  /// convex or compound shape.
  void addBody(BodyIndex index, btRigidBody& body);

  /// Set-up. A haptic sphere (device or proxy): obstacles near it are reported by nearSpheres().
  void addSphere(BodyIndex index, double radius);

  /// Once per host step, from the host's thread: finds the static objects within `margin` [m] of
  /// each body and sphere, given their states by index. May allocate when a new obstacle comes
  /// near.
  void update(const std::vector<RigidState>& states, double margin);

  /// Obstacles near the spheres whose shape the island knows itself (sphere, box, capsule, plane).
  [[nodiscard]] const std::vector<Obstacle>& nearSpheres() const noexcept;

  [[nodiscard]] bool isNear(BodyIndex body, const RigidState& state,
                            double reach) const noexcept override;
  void predict(BodyIndex body, const RigidState& before, const RigidState& after) noexcept override;
  void solve(double dt) noexcept override;
  bool correct(BodyIndex body, RigidState& after) noexcept override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
