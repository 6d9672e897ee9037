#pragma once

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// A body of a Bullet world that represents a body of a host with another engine.
///
/// Each host step calls takeHostChanges(), steps the Bullet world and calls handOff(). The host's
/// engine then steps with the given velocities, and takeBack() follows. Engines use x += v dt, with
/// v after the forces acted. They thus bring a free body exactly to its pose in the world. The
/// world and the body must outlive this. All functions are real-time safe and for one thread.
class GuestBody {
 public:
  GuestBody(btDiscreteDynamicsWorld& world, btRigidBody& body) noexcept;

  /// Applies the host's changes to its body since the last hand-over to ours. A different pose is a
  /// move, a different velocity an impulse. Rounding to float does not count.
  void takeHostChanges(const RigidState& now) noexcept;

  /// The host's pose, with the velocities that carry it within dt [s] to the body's pose in the
  /// world. The effect of the host's gravity [m/s^2] is subtracted:
  ///
  ///   v = (x1 - x0) / dt - g dt        w = rotation vector from q0 to q1 / dt
  [[nodiscard]] RigidState handOff(double dt, const Vec3& host_gravity_W) noexcept;

  /// Applies other effects of the host's engine, visible in `now`, to our body: the pose that they
  /// led to, and an impulse. It keeps the change of velocity, and of angular momentum at the body's
  /// inertia. Returns the state that the host must set.
  [[nodiscard]] RigidState takeBack(const RigidState& now) noexcept;

 private:
  [[nodiscard]] Vec3 turnAlong(const Vec3& dw_W, const Quat& from) const noexcept;

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  RigidState told_;      ///< last state that the host received
  RigidState start_;     ///< the host's state when its step began
  RigidState expected_;  ///< the host's state at the end of the step if nothing else acts
  double speed_ = 0.0;   ///< largest velocity that may cause rounding in the host [m/s]
};

}  // namespace tandem
#pragma GCC visibility pop
