#pragma once

#include <memory>
#include <string>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "bench/guest/guest_arm_plan.h"
#include "bench/program/draw.h"

namespace tandem::demos::bench {

/// A multi-body of a host with its colliders, motors, limits and ties. It must leave a world that
/// lives longer.
class GuestArm {
 public:
  /// A motor, limit or tie.
  struct Hold {
    std::unique_ptr<btMultiBodyConstraint> constraint;
    const btRigidBody* body = nullptr;  ///< what a tie holds, if a body
    bool is_tie = false;
  };

  /// `step`: of the host's solver [s]. Motors and limits are drawn with the arm.
  GuestArm(const GuestArmPlan& plan, double step);

  [[nodiscard]] btMultiBody& body() { return *body_; }
  [[nodiscard]] const btMultiBody& body() const { return *body_; }
  [[nodiscard]] const std::vector<std::unique_ptr<btMultiBodyLinkCollider>>& colliders() const {
    return colliders_;
  }
  [[nodiscard]] const std::vector<Hold>& holds() const { return holds_; }
  [[nodiscard]] bool isInWorld() const { return world_ != nullptr; }
  /// True if it has or had a tie.
  [[nodiscard]] bool wasTied() const { return was_tied_; }

  void add(btMultiBodyDynamicsWorld& world);
  void remove();
  /// Its world ends with the arm in it, without its motors and ties.
  void forgetWorld() { world_ = nullptr; }
  /// Puts it where it was made, at rest.
  void reset();
  /// After a change of joint positions.
  void showPose();

  /// Adds a motor to a link with a joint that takes one.
  void addMotor(int link, Draw& draw);
  void addLimit(int link, Draw& draw);
  /// Adds a tie of a link: to a body, to another link (`other` >= 0) or to the world.
  void addTie(int link, btRigidBody* body, int other, Draw& draw);
  void removeHold(std::size_t index);
  void removeAllHolds();
  /// Removes the ties to a body, as Bullet asks before the body goes.
  void removeTiesOf(const btRigidBody& body);

  void addTorque(int link, int dof, double torque);
  void addForce(int link, const Vec3& f_W);

  /// Energy of motion and weight [J].
  [[nodiscard]] double energy(const Vec3& g_W) const;
  /// Most that motors and the host's torques and forces do over `dt` at the present speeds [J].
  /// Bounds of motors count per step of the solver.
  [[nodiscard]] double mostWork(double dt) const;
  /// The host's torques and forces act for one frame.
  void forgetPushes() { torque_ = force_ = 0.0; }
  /// Greatest speed of a link's centre [m/s].
  [[nodiscard]] double speed() const;
  [[nodiscard]] std::vector<Vec3> places() const;
  [[nodiscard]] bool isFinite() const;
  /// True if all joint positions and velocities, and the base's, are equal to the bit.
  [[nodiscard]] bool isAt(const GuestArm& other) const;
  /// Takes the motion of another arm of the same plan, awake and without forces.
  void takeMotion(const GuestArm& from);

  static constexpr double kReach = 0.5;  ///< no arm of the plans is longer [m]

 private:
  struct Motion {
    Vec3 v_W, w_B;
  };

  void setUpLink(int index, const GuestLinkPlan& link);
  void addCollider(int link, const Vec3& half);
  void addHold(std::unique_ptr<btMultiBodyConstraint> one, const btRigidBody* body, bool is_tie);
  [[nodiscard]] std::vector<Motion> motions() const;
  [[nodiscard]] double greatestRate() const;

  GuestArmPlan plan_;
  double step_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::unique_ptr<btMultiBody> body_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<Hold> holds_;
  btMultiBodyDynamicsWorld* world_ = nullptr;
  bool was_tied_ = false;
  double torque_ = 0.0, force_ = 0.0;  ///< of the host in this frame [N m], [N]
};

/// Settings in which two arms differ that should be equal; empty if there is none. Joint positions,
/// velocities and sleep are not compared.
[[nodiscard]] std::string compareArms(const GuestArm& arm, const GuestArm& twin);

}  // namespace tandem::demos::bench
