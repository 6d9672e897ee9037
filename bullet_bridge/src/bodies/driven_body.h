#pragma once

#include "coordination/src/island/island.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

#pragma GCC visibility push(default)
namespace tandem {

/// A kinematic body of the host's world: a gripper, a lift, a belt. The host moves it by hand;
/// where it will be until the host is heard again is guessed from its velocity.
///
/// Bullet works out a kinematic body's velocity when stepSimulation() begins, over all its
/// sub-steps, and has the pose of their end from the first of them on. One whose pose stays while
/// it has a velocity is a belt: only its surface moves. For the thread that steps the host's world;
/// real-time safe.
class DrivenBody {
 public:
  /// Seen at the host's simulated time `time` [s]. The world must outlive this; the body need not.
  DrivenBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double time) noexcept;

  [[nodiscard]] bool isInWorld() const noexcept;

  /// In the pre-tick or post-tick of a step of the host that ends at `time` [s].
  void look(double time) noexcept;
  /// When it is, or will be, where it was seen [s]: the end of the host's step, or of a later
  /// sub-step of the same call.
  [[nodiscard]] double seenAt() const noexcept { return stamp_; }

  /// kHeld for a belt, else kPrescribed.
  [[nodiscard]] Motion motion() const noexcept;

  /// Where it is at `time` if it goes on as it was seen.
  [[nodiscard]] RigidState at(double time) const noexcept;

  /// The state to set an island's body to that stands at `now` at `time`, so that it would be right
  /// `within` [s]: without a jump, unless it is more than 5 cm or 0.5 rad off.
  [[nodiscard]] RigidState steer(const RigidState& now, double time, double within) const noexcept;

 private:
  [[nodiscard]] RigidState read() const noexcept;

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  mutable int world_index_;
  RigidState seen_;
  double stamp_;
  bool is_belt_ = false;
};

}  // namespace tandem
#pragma GCC visibility pop
