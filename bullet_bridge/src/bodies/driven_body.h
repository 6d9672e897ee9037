#pragma once

#include "coordination/src/island/island.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// True if a step made a kinematic body so much faster that its way was a jump. Pure.
[[nodiscard]] inline bool isLeap(const RigidState& before, const RigidState& now) noexcept {
  constexpr double kLeap = 3.0, kLeapTurn = 30.0;  // [m/s], [rad/s]
  return (now.v_W - before.v_W).norm() >= kLeap || (now.w_W - before.w_W).norm() >= kLeapTurn;
}

/// True if the host put a kinematic body elsewhere in a step, instead of moving it there. After a
/// jump it moves on as the jump said, or as one that stood there: `was_put` is the answer of the
/// step before. Pure.
[[nodiscard]] inline bool isPut(const RigidState& before, const RigidState& now,
                                bool was_put) noexcept {
  return isLeap(before, now) && !(was_put && !isLeap({}, now));
}

/// A kinematic body of the host's world: a gripper, a lift, a belt. The host moves it; between the
/// host's steps its pose is extrapolated from its velocity.
///
/// Bullet computes a kinematic body's velocity when stepSimulation() begins, over all its
/// sub-steps. The body has the final pose from the first sub-step on. A body with a velocity whose
/// pose stays is a belt: only its surface moves. One that Bullet says has become faster by 3 m/s or
/// 30 rad/s in a step was put elsewhere: it stands there until the next step says the same. For the
/// thread that steps the host's world; real-time safe.
class DrivenBody {
 public:
  /// Reads the body at the host's simulated time `time` [s]. The world must outlive this; the body
  /// need not.
  DrivenBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double time) noexcept;

  [[nodiscard]] bool isInWorld() const noexcept;

  /// Reads the body in the pre-tick or post-tick of a host step that ends at `time` [s].
  void look(double time) noexcept;
  /// The host has moved the body by `offset_W` [m], with all else in its world.
  void shiftOrigin(const Vec3& offset_W) noexcept { seen_.p_W += offset_W; }
  /// Time at which the body has the pose last read [s]: the end of the host's step, or of a later
  /// sub-step of the same call.
  [[nodiscard]] double seenAt() const noexcept { return stamp_; }

  /// kHeld for a belt, else kPrescribed.
  [[nodiscard]] Motion motion() const noexcept;

  /// State at `time` [s], extrapolated from the last reading.
  [[nodiscard]] RigidState at(double time) const noexcept;

  /// State to set an island body that is at `now` at `time`, so that it is right after `within`
  /// [s]. It does not jump unless it was put elsewhere, or is more than 5 cm or 0.5 rad off.
  [[nodiscard]] RigidState steer(const RigidState& now, double time, double within) const noexcept;

 private:
  [[nodiscard]] RigidState read() const noexcept;
  [[nodiscard]] bool goesOn() const noexcept { return !is_belt_ && !was_put_; }

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  mutable int world_index_;
  RigidState seen_;
  double stamp_;
  bool is_belt_ = false;
  bool was_put_ = false;  ///< its last way is no motion
};

}  // namespace tandem
#pragma GCC visibility pop
