#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "coordination/src/island/joint_source.h"
#include "joints/acting_joints.h"
#include "joints/joint_copy.h"
#include "joints/moved_frames.h"

class btDiscreteDynamicsWorld;
class btRigidBody;
class btTypedConstraint;

#pragma GCC visibility push(default)
namespace tandem {

/// Joints of the host's world between bodies that the island holds.
///
/// The island solves them on private copies. Joints are off while Bullet's solver runs, and the
/// host finds them on as it left them. Those that it removes, or switches off, end at once. What
/// one of two joints between the same bodies holds, the other leaves out (HeldWays).
class HostJoints final : public JointSource {
 public:
  /// Index of a body in the island; none: the island does not hold it.
  using Find = std::function<std::optional<BodyIndex>(const btRigidBody&)>;

  HostJoints(btDiscreteDynamicsWorld& host, const MovedFrames& moved)
      : host_(host), moved_(moved) {}

  /// @name For the thread that steps the host's world.
  /// @{
  /// Finds the joints that the island should solve: it holds both ends, or one while the other is
  /// static, and their frames do not move.
  void look(const Find& find);
  /// Marks joints that the host has removed or switched off, or whose frames it moves.
  void findGone() noexcept;
  /// True if the host has added, removed or changed a joint since the last look() and refresh().
  [[nodiscard]] bool hasNews() noexcept;
  /// Around Bullet's solver. Pre-tick, after findGone(); post-tick, first of all.
  void switchOff() noexcept;
  void switchOn() noexcept;
  /// The host's world ends: no joint of it may be read.
  void forgetWorld() noexcept;
  /// @}

  /// @name For the thread that ticks, while the host's thread waits. Real-time safe.
  /// @{
  /// Applies the results of look(). True if the joints have changed.
  bool take() noexcept;
  /// Reads how the host changed its motors and limits for its step of `dt` [s]. True if it changed
  /// any.
  bool refresh(double dt) noexcept;
  /// A host step of `dt` [s] has ended: the host finds the joints' impulses and forces, and those
  /// that were too great for a joint break it. True if any broke.
  bool tell(double dt) noexcept;
  /// Ends joints that have gone. True if there were any.
  bool dropGone() noexcept;
  /// Ends the joints of a body that leaves the island.
  void drop(BodyIndex body) noexcept;
  /// @}

  [[nodiscard]] const std::vector<JointEnds>& joints() const noexcept override {
    return acting_.ends();
  }
  [[nodiscard]] double rounding() const noexcept override;
  void evaluate(std::size_t joint, const RigidState& a, const RigidState& b,
                std::vector<JointRow>& rows) noexcept override;
  void note(std::size_t joint, const JointRow& row, double impulse, double h,
            bool is_first) noexcept override;

 private:
  /// What a joint gave its ends since the last tell().
  struct Given {
    double time = 0.0;
    double impulse[kMostJointRows] = {};  ///< by row [N s, N m s]
    int last = 0;                         ///< number of the last row
    Vec3 linear_W = Vec3::Zero();         ///< to a; b got the opposite
    Vec3 angular_a_W = Vec3::Zero(), angular_b_W = Vec3::Zero();
  };
  struct Joint {
    btTypedConstraint* host;
    const btRigidBody *a, *b;
    JointEnds ends;
    std::unique_ptr<JointCopy> copy;
    RigidState fixed_a = {}, fixed_b = {};  ///< of ends that stand
    Given given = {};                       ///< since the last tell()
    Given told = {};                        ///< Bullet forgets it in each step
    bool is_gone = false, is_off = false;
  };

  [[nodiscard]] static bool haveSameEnds(const Joint& one, const Joint& other) noexcept;
  [[nodiscard]] bool isAsWanted() const noexcept;
  void listActing() noexcept;
  void ask(std::size_t joint, const RigidState& a, const RigidState& b,
           std::vector<JointRow>& rows) const noexcept;
  void leaveOutHeld(std::size_t joint, const RigidState& a, const RigidState& b, std::size_t first,
                    std::vector<JointRow>& rows) noexcept;

  btDiscreteDynamicsWorld& host_;
  const MovedFrames& moved_;
  std::vector<Joint> joints_, next_;
  bool has_next_ = false;
  int looked_at_ = 0;  ///< joints of the host's world at the last look()
  ActingJoints acting_;
  /// By the island's index: the joint before between the same bodies, or itself.
  std::vector<std::size_t> elder_;
  std::vector<JointRow> elders_rows_;
};

}  // namespace tandem
#pragma GCC visibility pop
