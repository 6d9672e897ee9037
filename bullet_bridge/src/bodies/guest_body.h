#pragma once

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// A body of a Bullet world that stands for one in a host with another engine.
///
/// In each step of the host: takeHostChanges(), a step of the Bullet world, handOff(), a step of
/// the host's engine with the velocities given, takeBack(). An engine that moves bodies by the
/// velocity they have after forces acted, x += v dt, brings a free body exactly to where the world
/// has it. The world and the body must outlive this. All are real-time safe and for one thread.
class GuestBody {
 public:
  GuestBody(btDiscreteDynamicsWorld& world, btRigidBody& body) noexcept;

  /// What the host has done to its body, `now`, since it was told last goes to ours: a pose that
  /// differs is a move, a velocity an impulse. Not what differs by rounding to float.
  void takeHostChanges(const RigidState& now) noexcept;

  /// The host's pose, with the velocities that carry it in dt to where the world has the body now,
  /// less what the host's gravity [m/s^2] will add:
  ///
  ///   v = (x1 - x0) / dt - g dt        w = rotation vector from q0 to q1 / dt
  [[nodiscard]] RigidState handOff(double dt, const Vec3& host_gravity_W) noexcept;

  /// What the host's engine did besides, as `now` shows it, goes to our body as an impulse: the
  /// change of velocity at its mass, and of angular momentum at its inertia. Returns what the host
  /// is to set.
  [[nodiscard]] RigidState takeBack(const RigidState& now) noexcept;

 private:
  [[nodiscard]] Vec3 turnAlong(const Vec3& dw_W, const Quat& from) const noexcept;

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  RigidState told_;      ///< as the host was told last
  RigidState start_;     ///< the host's, when its step began
  RigidState expected_;  ///< the host's at the end of the step if nothing else acts
  double speed_ = 0.0;   ///< largest velocity that rounding in the host may come from [m/s]
};

}  // namespace tandem
#pragma GCC visibility pop
