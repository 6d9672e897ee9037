// Joint copies give rows without the heap.

#include <vector>

#include <gtest/gtest.h>

#include <btBulletDynamicsCommon.h>

#include "tandem/bullet_bridge/convert.h"

#include "bullet_bridge/src/joints/joint_copy.h"
#include "realtime/allocation_count.h"

namespace tandem {
namespace {

TEST(JointAllocation, NoneInRefreshNorEvaluate) {
  btSphereShape ball(btScalar(0.05));
  const btVector3 inertia(btScalar(1e-3), btScalar(1e-3), btScalar(1e-3));
  btRigidBody a(btScalar(1), nullptr, &ball, inertia), b(btScalar(1), nullptr, &ball, inertia);
  const btTransform frame = toBullet(Vec3(0.1, 0.0, 0.0), Quat::Identity());
  btHingeConstraint hinge(a, b, frame, frame);
  hinge.setLimit(btScalar(-0.001), btScalar(0.001));
  hinge.enableAngularMotor(true, btScalar(1), btScalar(1));
  btConeTwistConstraint cone(a, b, frame, frame);
  cone.setLimit(btScalar(0.3), btScalar(0.2), btScalar(0.001));
  btGeneric6DofSpring2Constraint six(a, b, frame, frame);
  for (int axis = 0; axis < 6; ++axis) {
    six.enableSpring(axis, true);
    six.setStiffness(axis, btScalar(10));
  }
  std::vector<btTypedConstraint*> hosts{&hinge, &cone, &six};
  std::vector<JointCopy> copies;
  for (btTypedConstraint* host : hosts) copies.emplace_back(*host, HostSolver{});
  std::vector<JointRow> rows;
  rows.reserve(kMostJointRows);
  RigidState state_a, state_b;

  const test::AllocationCount count;
  std::size_t seen = 0;
  for (int tick = 0; tick < 1000; ++tick)
    for (std::size_t i = 0; i < hosts.size(); ++i) {
      state_b.p_W.x() = 1e-5 * tick;
      state_b.q_WB = Quat(Eigen::AngleAxisd(1e-4 * tick, Vec3(1, 2, 3).normalized()));
      if (tick % 16 == 0) copies[i].refresh(*hosts[i], HostSolver{});
      rows.clear();
      copies[i].evaluate(state_a, state_b, rows);
      seen += rows.size();
    }
  EXPECT_EQ(count.count(), 0u);
  EXPECT_GT(seen, 20000u);
}

}  // namespace
}  // namespace tandem
