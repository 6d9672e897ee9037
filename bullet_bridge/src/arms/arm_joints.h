#pragma once

#include <array>
#include <vector>

#include <LinearMath/btScalar.h>

#include "arms/host_arm.h"
#include "arms/pay_window.h"
#include "coordination/src/island/joint_source.h"
#include "joints/acting_joints.h"
#include "joints/joint_copy.h"

class btMultiBodyConstraint;
class btMultiBodyDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// The joints of multi-bodies that the island holds, with their motors and limits.
///
/// While Bullet's solver runs, limits of the host's world are without force, and motors only hold
/// what was handed off. The host finds them as it left them. Torques that the host gives a joint
/// act along it for a host step. Functions and threads are those of HostJoints.
class ArmJoints final : public JointSource {
 public:
  /// A body of the island that is a link of an arm.
  struct Member {
    const LinkBody* link = nullptr;
    BodyIndex index = 0;
  };

  /// `host` may have no multi-bodies: null.
  explicit ArmJoints(btMultiBodyDynamicsWorld* host) noexcept : host_(host) {}

  /// `members`: all links of all arms that the island holds, each arm's one after another.
  void look(const std::vector<Member>& members);
  void switchOff() noexcept;
  void switchOn() noexcept;
  /// The host's world ends: none of its arms may be read.
  void forgetWorld() noexcept;

  bool take() noexcept;
  bool refresh(const PayWindow& window) noexcept;
  /// The host is silent: its torques end.
  void endTorques() noexcept;
  void tell(double dt) noexcept;
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
  /// Impulses of a joint on its link since the last tell().
  struct Given {
    double time = 0.0;
    double motor = 0.0, limit[2] = {};  ///< impulses [N s, N m s]; limit: low, high
    Vec3 linear_W = Vec3::Zero(), angular_W = Vec3::Zero();  ///< by all but these
  };
  struct Joint {
    const LinkBody* link;
    LinkKind kind;
    JointEnds ends;
    JointSettings settings;
    JointCopy copy;          ///< of the settings, for the thread that ticks
    RigidState ground = {};  ///< of an end that stands
    Given given = {}, told = {};
    double by_bullet = 0.0;  ///< impulse of the motor in Bullet's last step [N s, N m s]
    double owed = 0.0;       ///< impulse of the host's torques that is yet to be given [N s, N m s]
    btMultiBodyConstraint *motor = nullptr, *limit = nullptr;  ///< as last refreshed
    bool is_gone = false;
  };
  /// A motor or limit, with the greatest impulse that the host gave it, and a motor's settings.
  struct Off {
    btMultiBodyConstraint* constraint;
    btScalar impulse;
    std::array<btScalar, 5> motor;
  };

  [[nodiscard]] bool isAsWanted() const noexcept;
  [[nodiscard]] Joint* findJoint(btMultiBodyConstraint& constraint) noexcept;
  void readConstraint(btMultiBodyConstraint& constraint, double dt) noexcept;
  void tellFeedback(const Joint& joint) noexcept;

  btMultiBodyDynamicsWorld* host_;
  std::vector<Joint> joints_, next_;
  bool has_next_ = false;
  std::vector<Off> off_;
  ActingJoints acting_;
  std::vector<RigidState> states_;  ///< working memory
};

}  // namespace tandem
#pragma GCC visibility pop
