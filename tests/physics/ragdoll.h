#pragma once

#include <cstddef>

#include "physics/joint_host.h"

namespace tandem::test {

/// Bullet's ragdoll without its head, half as tall: ten capsules of 1 kg, hinges and cone twists
/// with limits. It stands along y, with its arms out. Its parts stand where its joints are closed.
class Ragdoll {
 public:
  enum Part { kPelvis, kSpine, kThighL, kShinL, kThighR, kShinR, kArmL, kHandL, kArmR, kHandR };
  static constexpr std::size_t kParts = 10;

  explicit Ragdoll(JointHost& host) : host_(host) {
    constexpr double kQuarter = 1.5707963267948966;  // [rad]
    add(0.15, 0.20, Vec3(0, 1, 0), 0);
    add(0.15, 0.28, Vec3(0, 1.3, 0), 0);
    for (const double side : {-1.0, 1.0}) {
      add(0.07, 0.45, Vec3(0.18 * side, 0.65, 0), 0);
      add(0.05, 0.37, Vec3(0.18 * side, 0.24, 0), 0);
    }
    for (const double side : {-1.0, 1.0}) {
      add(0.05, 0.33, Vec3(0.35 * side, 1.45, 0), -side * kQuarter);
      add(0.04, 0.25, Vec3(0.67 * side, 1.45, 0), -side * kQuarter);
    }
    hinge(kPelvis, Vec3(0, 0.15, 0), kSpine, Vec3(0, -0.15, 0), -0.5 * kQuarter, kQuarter);
    twist(kPelvis, Vec3(-0.18, -0.125, 0), -2.5 * kQuarter, kThighL, Vec3(0, 0.225, 0),
          -2.5 * kQuarter, 0.5 * kQuarter);
    hinge(kThighL, Vec3(0, -0.225, 0), kShinL, Vec3(0, 0.185, 0), -kPlay, kQuarter);
    twist(kPelvis, Vec3(0.18, -0.125, 0), 0.5 * kQuarter, kThighR, Vec3(0, 0.225, 0),
          0.5 * kQuarter, 0.5 * kQuarter);
    hinge(kThighR, Vec3(0, -0.225, 0), kShinR, Vec3(0, 0.185, 0), -kPlay, kQuarter);
    twist(kSpine, Vec3(-0.17, 0.15, 0), 2.0 * kQuarter, kArmL, Vec3(0, -0.18, 0), kQuarter,
          kQuarter);
    hinge(kArmL, Vec3(0, 0.18, 0), kHandL, Vec3(0, -0.14, 0), -kPlay, kQuarter);
    twist(kSpine, Vec3(0.17, 0.15, 0), 0, kArmR, Vec3(0, -0.18, 0), kQuarter, kQuarter);
    hinge(kArmR, Vec3(0, 0.18, 0), kHandR, Vec3(0, -0.14, 0), -kPlay, kQuarter);
  }

  [[nodiscard]] btRigidBody& part(Part part) { return *host_.links[part]; }

 private:
  static constexpr double kScale = 0.5;
  /// Knees and elbows of Bullet's stand at their limits. They would meet these at the moments of
  /// other blows, and the order of blows decides what follows [rad].
  static constexpr double kPlay = 0.2;

  static btScalar scaled(double length) { return static_cast<btScalar>(kScale * length); }
  static btTransform frame(const Quat& q, const Vec3& at) { return toBullet(Vec3(kScale * at), q); }

  void add(double radius, double height, const Vec3& at, double turn_z) {
    auto& shape = host_.rig.makeShape<btCapsuleShape>(scaled(radius), scaled(height));
    host_.add(shape, 1.0, kScale * at, turn(turn_z, Vec3::UnitZ()));
  }
  void hinge(Part a, const Vec3& at_a, Part b, const Vec3& at_b, double low, double high) {
    const Quat about_x = turn(1.5707963267948966, Vec3::UnitY());
    auto& joint =
        host_.join<btHingeConstraint>(part(a), part(b), frame(about_x, at_a), frame(about_x, at_b));
    joint.setLimit(static_cast<btScalar>(low), static_cast<btScalar>(high));
  }
  void twist(Part a, const Vec3& at_a, double turn_a, Part b, const Vec3& at_b, double turn_b,
             double swing) {
    auto& joint = host_.join<btConeTwistConstraint>(part(a), part(b),
                                                    frame(turn(turn_a, Vec3::UnitZ()), at_a),
                                                    frame(turn(turn_b, Vec3::UnitZ()), at_b));
    joint.setLimit(static_cast<btScalar>(swing), static_cast<btScalar>(swing), 0);
  }

  JointHost& host_;
};

}  // namespace tandem::test
