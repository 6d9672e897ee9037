#pragma once

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

/// \file
/// What a host does with its Bullet world, for code that does not see Bullet's headers. All are for
/// the thread that steps the world, and not while it steps.
#pragma GCC visibility push(default)
namespace tandem {

/// The rigid body at this address if the world has it, else null. Compares addresses first: the
/// body may have been deleted. `hint` is where it stood last time, which saves the search; it is
/// kept up to date, and -1 at first.
[[nodiscard]] btRigidBody* findRigidBody(const btDiscreteDynamicsWorld& world, const void* body,
                                         int& hint) noexcept;

/// True for a body that forces move.
[[nodiscard]] bool isDynamic(const btRigidBody& body) noexcept;

[[nodiscard]] RigidState readState(const btRigidBody& body) noexcept;

/// Puts the body there, awake. A static body keeps its velocity of zero.
void putBody(btDiscreteDynamicsWorld& world, btRigidBody& body, const RigidState& state) noexcept;

/// Adds to the velocities of a body and wakes it; its pose stays, to the bit.
void pushBody(btRigidBody& body, const Vec3& dv_W, const Vec3& dw_W) noexcept;

/// A force at the centre of mass [N] and a torque [N m] for the next stepSimulation(); wakes it.
void applyForce(btRigidBody& body, const Vec3& f_W, const Vec3& t_W) noexcept;

/// For all bodies that take the world's gravity [m/s^2].
void setWorldGravity(btDiscreteDynamicsWorld& world, const Vec3& gravity_W) noexcept;

/// stepSimulation(). Throws what a callback of the host throws.
void stepWorld(btDiscreteDynamicsWorld& world, double dt, int max_substeps, double fixed_step);

}  // namespace tandem
#pragma GCC visibility pop
