#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "coordination/src/island/joint_source.h"

namespace tandem::test {

/// Joints in closed form for tests: a ball, or a hinge with a stop and a motor.
class PlainJoints final : public JointSource {
 public:
  struct Motor {
    double speed, force;  ///< [rad/s], [N m]
  };
  struct Joint {
    Vec3 at_A, at_B;  ///< pivot in both ends; of a fixed end in W
    std::optional<Vec3> axis_A, axis_B;
    std::optional<double> least_angle;  ///< of a about the axis, from the pose of b [rad]
    double bounce = 0.0;
    std::optional<Motor> motor;
  };

  void add(BodyIndex a, BodyIndex b, const Joint& joint) {
    kinds_.push_back(joint);
    ends_.push_back({a, b, reinterpret_cast<const void*>(kinds_.size())});
  }
  [[nodiscard]] Joint& joint(std::size_t i) { return kinds_[i]; }

  [[nodiscard]] const std::vector<JointEnds>& joints() const noexcept override { return ends_; }
  [[nodiscard]] double rounding() const noexcept override {
    return std::numeric_limits<double>::epsilon();
  }
  void evaluate(std::size_t index, const RigidState& a, const RigidState& b,
                std::vector<JointRow>& rows) noexcept override {
    const Joint& joint = kinds_[index];
    const Vec3 arm_a = a.q_WB * joint.at_A, arm_b = b.q_WB * joint.at_B;
    const Vec3 apart = a.p_W + arm_a - b.p_W - arm_b;
    int number = 0;
    for (const Vec3& n : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
      JointRow row;
      row.number = number++;
      row.n_W = n;
      row.turn_b_W = -arm_b.cross(n);
      // As if b took part of the gap: no angular momentum is made.
      row.turn_a_W = (arm_a - apart).cross(n);
      row.way = apart.dot(n);
      rows.push_back(row);
    }
    if (!joint.axis_A) return;
    const Vec3 axis_a = a.q_WB * *joint.axis_A, axis_b = b.q_WB * *joint.axis_B;
    const Vec3 s = joint.axis_A->unitOrthogonal();
    const Vec3 tilt = axis_b.cross(axis_a);
    for (const Vec3& n_A : {s, Vec3(joint.axis_A->cross(s))}) {
      JointRow row;
      row.number = number++;
      row.turn_a_W = a.q_WB * n_A;
      row.turn_b_W = -row.turn_a_W;
      row.way = tilt.dot(row.turn_a_W);
      rows.push_back(row);
    }
    JointRow row;
    row.turn_a_W = axis_a;
    row.turn_b_W = -axis_a;
    if (joint.least_angle) {
      const Quat turn = b.q_WB.conjugate() * a.q_WB;
      row.law = JointLaw::kLimit;
      row.number = 5;
      row.bounce = joint.bounce;
      row.way = 2.0 * std::atan2(turn.vec().dot(*joint.axis_B), turn.w()) - *joint.least_angle;
      rows.push_back(row);
    }
    if (joint.motor) {
      row.law = JointLaw::kMotor;
      row.number = 6;
      row.bounce = row.way = 0.0;
      row.speed = joint.motor->speed;
      row.low = -joint.motor->force;
      row.high = joint.motor->force;
      rows.push_back(row);
    }
  }
  void note(std::size_t joint, const JointRow& row, double impulse, double h,
            bool is_first) noexcept override {
    if (is_first) last_force_W = last_torque_W = Vec3::Zero();
    if (joint != noted) return;
    last_force_W += impulse / h * row.n_W;
    last_torque_W += impulse / h * row.turn_a_W;
  }

  std::size_t noted = 0;  ///< joint of which a's force is kept
  Vec3 last_force_W = Vec3::Zero(), last_torque_W = Vec3::Zero();

 private:
  std::vector<JointEnds> ends_;
  std::vector<Joint> kinds_;
};

}  // namespace tandem::test
