// Bodies that a host takes out of its world before it removes their joints.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "physics/joint_host.h"

namespace tandem {
namespace {

using test::byWidth;
using test::JointHost;

constexpr double kLength = JointHost::kLength;
constexpr double kStep = 1.0 / 60.0;  // [s]

const btVector3 kDrift(0, 0, btScalar(0.05));  // [m/s]
const Vec3 kLeft(-0.5 * kLength, 0.0, 0.0), kRight(0.5 * kLength, 0.0, 0.0);

/// A world without weight: a joint of a body that left stays about closed.
struct FloatingHost : JointHost {
  FloatingHost() { rig.world.setGravity(btVector3(0, 0, 0)); }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) rig.step(kStep);
  }
};

/// Three links on two pins drift along z. The outer ones are shared, the middle one is a neighbour.
struct ThreeLinks : FloatingHost {
  ThreeLinks() {
    for (int i = 0; i < 3; ++i) addLink(Vec3(i * kLength, 0.0, 0.0)).setLinearVelocity(kDrift);
    for (std::size_t i = 0; i < 2; ++i)
      join<btPoint2PointConstraint>(*links[i], *links[i + 1], toBullet(kRight), toBullet(kLeft));
    share(*links[0]);
    site->share(*links[2]);
    run(10);
  }
  void take(std::size_t leaving) { rig.world.removeRigidBody(links[leaving]); }
  /// Removes the joints of a link. Bullet looks at their bodies then.
  void removeJointsOf(std::size_t leaving) {
    std::erase_if(joints, [&](const auto& joint) {
      if (&joint->getRigidBodyA() != links[leaving] && &joint->getRigidBodyB() != links[leaving])
        return false;
      rig.world.removeConstraint(joint.get());
      return true;
    });
  }
  void destroy(std::size_t leaving) {
    std::erase_if(rig.bodies, [&](const auto& body) { return body.get() == links[leaving]; });
  }
  /// Bodies that stay move freely, and joints between them stay closed.
  void expectTheRestIsFree(std::size_t leaving) {
    run(30);
    const Vec3 before = sumSpeeds(leaving);
    run(30);
    EXPECT_LT((sumSpeeds(leaving) - before).norm(), byWidth(1e-6, 1e-4)) << leaving;
    if (leaving == 0) {
      EXPECT_LT(gap(*links[1], kRight, *links[2], kLeft), byWidth(1e-6, 1e-4));
    }
  }
  [[nodiscard]] Vec3 sumSpeeds(std::size_t leaving) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < links.size(); ++i)
      if (i != leaving) sum += fromBullet(links[i]->getLinearVelocity());
    return sum;
  }
};

// The island gives a body back whose shape changes, and takes it anew with its joints.
TEST(HostJoints, ABodyThatIsTakenAnewStaysInItsJoint) {
  FloatingHost host;
  for (int i = 0; i < 2; ++i) host.addLink(Vec3(i * kLength, 0.0, 0.0));
  btRigidBody &first = *host.links[0], &second = *host.links[1];
  host.join<btPoint2PointConstraint>(first, second, toBullet(kRight), toBullet(kLeft));
  host.share(first);
  host.site->share(second);
  host.run(10);
  second.getCollisionShape()->setMargin(btScalar(0.002));
  host.run(2);
  second.setLinearVelocity(btVector3(btScalar(0.5), 0, btScalar(0.5)));
  for (int i = 0; i < 30; ++i) {
    host.run(1);
    ASSERT_LT(host.gap(first, kRight, second, kLeft), byWidth(1e-6, 1e-4)) << i;
  }
}

class LeavingLink : public ::testing::TestWithParam<std::size_t> {};
// The first is shared, the second a neighbour.
INSTANTIATE_TEST_SUITE_P(HostJoints, LeavingLink, ::testing::Values(0u, 1u));

TEST_P(LeavingLink, ABodyMayLeaveBeforeItsJoint) {
  ThreeLinks host;
  ASSERT_EQ(host.site->neighbourCount(), 1);
  host.take(GetParam());
  host.run(3);
  for (const btRigidBody* link : host.links)
    EXPECT_LT(fromBullet(link->getLinearVelocity()).norm(), 1.0);
  host.removeJointsOf(GetParam());
  host.expectTheRestIsFree(GetParam());
}

TEST_P(LeavingLink, ABodyMayLeaveAndEndBeforeTheNextStep) {
  ThreeLinks host;
  host.take(GetParam());
  host.removeJointsOf(GetParam());
  host.destroy(GetParam());
  host.expectTheRestIsFree(GetParam());
}

TEST_P(LeavingLink, ABodyMayLeaveAndEndSomeStepsLater) {
  ThreeLinks host;
  host.take(GetParam());
  host.run(3);
  host.removeJointsOf(GetParam());
  host.destroy(GetParam());
  host.expectTheRestIsFree(GetParam());
}

TEST_P(LeavingLink, ABodyMayComeBack) {
  ThreeLinks host;
  host.take(GetParam());
  host.run(1);
  host.rig.world.addRigidBody(host.links[GetParam()]);
  host.run(60);
  EXPECT_EQ(host.site->neighbourCount(), 1);
  EXPECT_LT(JointHost::gap(*host.links[0], kRight, *host.links[1], kLeft), byWidth(1e-6, 1e-4));
  EXPECT_LT(JointHost::gap(*host.links[1], kRight, *host.links[2], kLeft), byWidth(1e-6, 1e-4));
}

TEST(HostJoints, ADrivenBodyMayLeaveBeforeItsJoint) {
  FloatingHost host;
  btRigidBody& crank = host.addLink(Vec3(-kLength, 0.0, 0.0));
  btRigidBody& link = host.addLink(Vec3::Zero());
  crank.setMassProps(0, btVector3(0, 0, 0));
  crank.setCollisionFlags(crank.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  host.join<btPoint2PointConstraint>(crank, link, toBullet(kRight), toBullet(kLeft));
  host.share(link);
  host.run(10);
  ASSERT_EQ(host.site->neighbourCount(), 1);
  host.rig.world.removeRigidBody(&crank);
  host.run(10);
  EXPECT_EQ(host.site->neighbourCount(), 0);
  EXPECT_LT(JointHost::gap(crank, kRight, link, kLeft), 1e-3);
  host.rig.world.removeConstraint(host.joints[0].get());
  host.joints.clear();
  link.setLinearVelocity(kDrift);
  host.run(30);
  EXPECT_LT((fromBullet(link.getLinearVelocity()) - fromBullet(kDrift)).norm(), 1e-6);
}

}  // namespace
}  // namespace tandem
