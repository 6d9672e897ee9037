#pragma once

#include <vector>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

/// \file
/// Functions on a host's Bullet world, for code that does not include Bullet's headers. All are for
/// the thread that steps the world, between steps.
#pragma GCC visibility push(default)
namespace tandem {

/// The rigid body at this address if the world has it, else null. Compares addresses first: the
/// body may have been deleted. `hint` is its last index, which saves the search; it is updated, and
/// starts at -1.
[[nodiscard]] btRigidBody* findRigidBody(const btDiscreteDynamicsWorld& world, const void* body,
                                         int& hint) noexcept;

/// True for a body that forces move.
[[nodiscard]] bool isDynamic(const btRigidBody& body) noexcept;

[[nodiscard]] RigidState readState(const btRigidBody& body) noexcept;

/// Sets the body's pose and velocities and wakes it. A static body keeps its velocity of zero.
void putBody(btDiscreteDynamicsWorld& world, btRigidBody& body, const RigidState& state) noexcept;

/// Adds to the velocities of a body and wakes it; the pose stays unchanged, to the bit.
void pushBody(btRigidBody& body, const Vec3& dv_W, const Vec3& dw_W) noexcept;

/// Applies a force at the centre of mass [N] and a torque [N m] in the next stepSimulation(), and
/// wakes the body.
void applyForce(btRigidBody& body, const Vec3& f_W, const Vec3& t_W) noexcept;

/// Sets the gravity [m/s^2] of all bodies that use the world's.
void setWorldGravity(btDiscreteDynamicsWorld& world, const Vec3& gravity_W) noexcept;

/// A point of contact that Bullet's dispatcher knows. Vectors are in W.
struct WorldContact {
  const btRigidBody* a = nullptr;  ///< null: no rigid body
  const btRigidBody* b = nullptr;
  Vec3 p_a = Vec3::Zero(), p_b = Vec3::Zero();  ///< on the surfaces [m]
  Vec3 n = Vec3::Zero();                        ///< on b, towards a
  double distance = 0.0;                        ///< along n [m]; negative: they overlap
  double force = 0.0;                           ///< on a along n in the latest step [N]
  Vec3 friction = Vec3::Zero();                 ///< force on a across n [N]
};

/// All points of contact as of the latest step.
[[nodiscard]] std::vector<WorldContact> findContacts(btDiscreteDynamicsWorld& world);

/// Calls stepSimulation(). Throws if a callback of the host throws.
void stepWorld(btDiscreteDynamicsWorld& world, double dt, int max_substeps, double fixed_step);

}  // namespace tandem
#pragma GCC visibility pop
