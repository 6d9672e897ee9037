#pragma once

#include <array>
#include <optional>
#include <vector>

#include <LinearMath/btQuaternion.h>
#include <LinearMath/btVector3.h>

#include "arms/arm_constraint.h"
#include "arms/arm_joints.h"
#include "arms/held_rows.h"
#include "coordination/src/island/joint_source.h"
#include "joints/acting_joints.h"
#include "joints/host_joints.h"
#include "joints/joint_copy.h"

class btMultiBodyDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// Constraints of multi-bodies that the island holds as joints of their own (ArmConstraintKind).
///
/// Each acts within its bound of Bullet's, and mends a part of its error per step of the host. What
/// others hold already it leaves out (HeldRows). While Bullet's solver runs they are without force,
/// but for motors of spherical joints, which hold what was handed off. The host finds them as it
/// left them, with the island's impulses. Functions and threads are those of HostJoints.
class ArmConstraints final : public JointSource {
 public:
  /// `host` may have no multi-bodies: null.
  explicit ArmConstraints(btMultiBodyDynamicsWorld* host) noexcept : host_(host) {}

  /// Finds the constraints whose ends the island holds, or of which one stands. Rigid bodies are
  /// found as for HostJoints, links among `members` as for ArmJoints.
  void look(const HostJoints::Find& find, const std::vector<ArmJoints::Member>& members);
  /// Marks those that the host has removed.
  void findGone() noexcept;
  void switchOff() noexcept;
  void switchOn() noexcept;
  void forgetWorld() noexcept;

  bool take() noexcept;
  bool refresh(double dt) noexcept;
  void tell(double dt) noexcept;
  bool dropGone() noexcept;
  void drop(BodyIndex body) noexcept;

  [[nodiscard]] const std::vector<JointEnds>& joints() const noexcept override {
    return acting_.ends();
  }
  [[nodiscard]] double rounding() const noexcept override;
  void evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                std::vector<JointRow>& rows) noexcept override;
  void note(std::size_t joint, const JointRow& row, double impulse, double h,
            bool is_first) noexcept override;

 private:
  /// An end in the island.
  struct End {
    BodyIndex index = kStanding;
    const LinkBody* link = nullptr;  ///< that carries the end; null: a rigid body, or it stands
    RigidState standing = {};        ///< of an end that stands
  };
  /// What a constraint gave since the last tell().
  struct Given {
    double time = 0.0;
    double impulse[kMostJointRows] = {};  ///< by row [N s, N m s]
  };
  struct Joint {
    btMultiBodyConstraint* host;
    ArmConstraintKind kind;
    ArmConstraintEnds host_ends;
    End a, b;
    JointEnds ends;
    JointSettings settings = {};
    double mend = 0.0;  ///< speed per way that a tie closes [1/s]
    JointCopy copy{JointSettings()};
    Given given = {}, told = {};
    std::array<double, 3> by_bullet = {};  ///< of a motor in Bullet's last step [N m s]
    bool is_gone = false;
    // By row, as of the host's last step.
    std::array<bool, kMostJointRows> is_left_out = {};  ///< others hold it
    std::array<double, kMostJointRows> force = {};      ///< greatest [N or N m]
    std::array<double, kMostJointRows> open = {};       ///< way that nothing closes [m or rad]
  };
  /// What a constraint had before it was switched off.
  struct Off {
    std::size_t joint;
    btScalar impulse;
    btQuaternion target;
    btVector3 gain, damping, impulse_of_each;
    bool is_each;
  };

  [[nodiscard]] static std::optional<End> findEnd(const ArmConstraintEnd& end,
                                                  const HostJoints::Find& find,
                                                  const std::vector<ArmJoints::Member>& members);
  [[nodiscard]] bool isAsWanted() const noexcept;
  void read(Joint& joint, const HostSolver& solver) noexcept;
  void reserveRows();
  void leaveOutHeld() noexcept;
  void evaluateAtHost(const Joint& joint, HeldEnd& a, HeldEnd& b) noexcept;
  [[gnu::visibility("hidden")]] void holdSpeed(const Joint& joint, Off& off) noexcept;
  [[gnu::visibility("hidden")]] static void giveSettingsBack(const Joint& joint,
                                                             const Off& off) noexcept;
  void tellHost(Joint& joint, double dt) noexcept;
  [[nodiscard]] HostSolver readSolver(double dt) const noexcept;

  btMultiBodyDynamicsWorld* host_;
  std::vector<Joint> joints_, next_;
  bool has_next_ = false;
  std::vector<Off> off_;
  ActingJoints acting_;
  HeldRows held_, next_held_;
  std::vector<JointRow> rows_;  ///< working memory, as all below
  std::vector<const HostArm*> arms_;
  std::vector<const btRigidBody*> bodies_;
};

}  // namespace tandem
#pragma GCC visibility pop
