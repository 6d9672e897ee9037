#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/joints/joint_copy.h"

namespace tandem::test {

/// A joint of each type of Bullet, between two bodies of a world.
struct JointCase {
  const char* name;
  std::size_t bytes;  ///< of the object
  std::function<std::unique_ptr<btTypedConstraint>(btRigidBody&, btRigidBody&)> make;
  int locked;            ///< rows that hold whatever the pose
  bool has_limits;       ///< that drawn poses come to
  bool is_exact = true;  ///< Bullet's rows have the directions of ours
};

/// Where the joint's frames are in both bodies; not along any axis of either.
[[nodiscard]] inline btTransform frameInA() {
  return toBullet(Vec3(0.03, 0.01, 0.02), turn(0.4, Vec3(1.0, 2.0, 0.5)));
}
[[nodiscard]] inline btTransform frameInB() {
  return toBullet(Vec3(-0.02, 0.015, -0.04), turn(-0.7, Vec3(0.2, 1.0, 0.3)));
}

/// A case from a function that sets the joint up, after construction with both bodies and frames.
template <typename Joint, typename SetUp, typename... Arguments>
JointCase makeCase(const char* name, int locked, bool has_limits, SetUp set_up,
                   Arguments... arguments) {
  return {name, sizeof(Joint),
          [=](btRigidBody& a, btRigidBody& b) -> std::unique_ptr<btTypedConstraint> {
            auto joint = std::make_unique<Joint>(a, b, frameInA(), frameInB(), arguments...);
            set_up(*joint);
            return joint;
          },
          locked, has_limits};
}

/// The joint of a case between two boxes, with the bodies put together.
struct JointRig {
  explicit JointRig(const JointCase& of)
      : a(rig.addCube(0.5, 0.05)),
        b(rig.addCube(0.2, 0.03)),
        joint([&] {
          a.setWorldTransform(toBullet(Vec3(0.1, -0.2, 0.3), turn(0.8, Vec3(1.0, 0.3, 0.2))));
          b.setWorldTransform(a.getWorldTransform() * frameInA() * frameInB().inverse());
          return of.make(a, b);
        }()),
        copy(*joint, solver) {}

  [[nodiscard]] static RigidState stateOf(const btRigidBody& body) {
    RigidState state;
    state.p_W = fromBullet(body.getWorldTransform().getOrigin());
    state.q_WB = fromBullet(body.getWorldTransform().getRotation());
    return state;
  }

  /// Puts the host's bodies somewhere.
  void place(const RigidState& state_a, const RigidState& state_b) {
    a.setWorldTransform(toBullet(state_a.p_W, state_a.q_WB));
    b.setWorldTransform(toBullet(state_b.p_W, state_b.q_WB));
  }

  BulletRig rig;
  btRigidBody &a, &b;
  HostSolver solver;
  std::unique_ptr<btTypedConstraint> joint;
  JointCopy copy;
};

[[nodiscard]] std::vector<JointCase> makeJointCases();

}  // namespace tandem::test
