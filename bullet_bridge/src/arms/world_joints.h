#pragma once

#include <vector>

#include "arms/arm_constraints.h"
#include "arms/arm_joints.h"
#include "joints/host_joints.h"

#pragma GCC visibility push(default)
namespace tandem {

/// All joints of the host's world that the island solves: constraints between rigid bodies, joints
/// of multi-bodies, and their constraints. Functions and threads are those of HostJoints.
class WorldJoints final : public JointSource {
 public:
  WorldJoints(btDiscreteDynamicsWorld& host, const MovedFrames& moved)
      : rigid_(host, moved), arms_(asMultiBodyWorld(host)), constraints_(asMultiBodyWorld(host)) {}

  /// @name For the thread that steps the host's world.
  /// @{
  void look(const HostJoints::Find& find, const std::vector<ArmJoints::Member>& members);
  void findGone() noexcept {
    rigid_.findGone();
    constraints_.findGone();
  }
  [[nodiscard]] bool hasNews() noexcept { return rigid_.hasNews(); }
  void switchOff() noexcept;
  void switchOn() noexcept;
  void forgetWorld() noexcept;
  /// @}

  /// @name For the thread that ticks, while the host's thread waits. Real-time safe.
  /// @{
  bool take() noexcept;
  bool refresh(const PayWindow& window) noexcept;
  void endTorques() noexcept { arms_.endTorques(); }
  bool tell(double dt) noexcept;
  bool dropGone() noexcept;
  void drop(BodyIndex body) noexcept;
  /// @}

  [[nodiscard]] const std::vector<JointEnds>& joints() const noexcept override { return ends_; }
  [[nodiscard]] double rounding() const noexcept override { return rigid_.rounding(); }
  void evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                std::vector<JointRow>& rows) noexcept override;
  void note(std::size_t joint, const JointRow& row, double impulse, double h,
            bool is_first) noexcept override;

 private:
  /// Calls `visit(source, its index)` for the source that has the joint.
  template <typename Visit>
  void visit(std::size_t joint, Visit visit) noexcept;
  void list() noexcept;

  HostJoints rigid_;
  ArmJoints arms_;
  ArmConstraints constraints_;
  std::vector<JointEnds> ends_;  ///< in this order
};

}  // namespace tandem
#pragma GCC visibility pop
