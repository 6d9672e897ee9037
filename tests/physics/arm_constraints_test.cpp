// Constraints of multi-bodies near the hand that are joints of their own do what Bullet says.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>

#include "tandem/plugin/site.h"

#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;
using test::byWidth;
using test::kMass;

class ArmConstraintsAtRates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, ArmConstraintsAtRates, ::testing::Values(60.0, 240.0));

/// A link on a spherical joint, along x.
void buildBall(ArmHost& host) {
  ArmLinkPlan link;
  link.joint = btMultibodyLink::eSpherical;
  host.build({link});
}

Quat turnOf(const ArmHost& host) {
  const btScalar* q = host.arm().getJointPosMultiDof(0);
  return fromBullet(btQuaternion(q[0], q[1], q[2], q[3]));
}

Vec3 speedOf(const ArmHost& host) {
  const btScalar* u = host.arm().getJointVelMultiDof(0);
  return {u[0], u[1], u[2]};
}

/// Turns with a motor to a target, and gives the way there in tenths of a second.
std::vector<Quat> turnTo(const Quat& target, double rate, bool has_site) {
  ArmHost host;
  buildBall(host);
  const auto most = static_cast<btScalar>(100.0 / rate);
  auto& motor = host.add<btMultiBodySphericalJointMotor>(0, most);
  motor.setPositionTarget(toBullet(target), static_cast<btScalar>(12.0 / rate));
  if (has_site) host.startApart();
  std::vector<Quat> way;
  for (int i = 0; i < 40; ++i) {
    host.run(0.1, rate);
    way.push_back(turnOf(host));
  }
  if (has_site) {
    EXPECT_EQ(host.site->counters().promoted, 1U);
  }
  EXPECT_LT(turnOf(host).angularDistance(target), byWidth(1e-4, 2e-3));
  EXPECT_EQ(motor.getMaxAppliedImpulse(), most);
  return way;
}

TEST_P(ArmConstraintsAtRates, ASphericalMotorTurnsToItsTargetAsInBullet) {
  constexpr double kAngle = 0.4;
  const auto compare = [&](const Vec3& axis) {
    const Quat target(Eigen::AngleAxisd(kAngle, axis.normalized()));
    const std::vector<Quat> ours = turnTo(target, GetParam(), true);
    const std::vector<Quat> bullets = turnTo(target, GetParam(), false);
    double worst = 0.0;
    for (std::size_t i = 0; i < ours.size(); ++i)
      worst = std::max(worst, ours[i].angularDistance(bullets[i]));
    return worst;
  };
  EXPECT_LT(compare(Vec3(0.0, 1.0, 0.0)), 0.01 * kAngle);
  // Bullet steers by Euler angles, and goes another way about several axes.
  EXPECT_LT(compare(Vec3(1.0, -2.0, 0.5)), 0.03 * kAngle);
}

// Damping below 1 makes a spring with a damper out of the motor.
TEST_P(ArmConstraintsAtRates, ASoftSphericalMotorSagsAsInBullet) {
  std::array<Quat, 2> turns;
  for (const bool has_site : {false, true}) {
    ArmHost host;
    buildBall(host);
    auto& motor = host.add<btMultiBodySphericalJointMotor>(0, btScalar(100.0 / GetParam()));
    motor.setPositionTarget(btQuaternion::getIdentity(), btScalar(20.0 / GetParam()));
    motor.setDamping(btVector3(1, 1, 1) * btScalar(20.0 / GetParam()));
    if (has_site) host.startApart();
    host.run(4.0, GetParam());
    turns[has_site ? 1 : 0] = turnOf(host);
  }
  const double sag = turns[0].angularDistance(Quat::Identity());
  EXPECT_GT(sag, 0.01);
  EXPECT_LT(turns[0].angularDistance(turns[1]), 2e-3 * sag + byWidth(0.0, 1e-5));
}

TEST_P(ArmConstraintsAtRates, ASphericalMotorGivesItsGreatestTorque) {
  constexpr double kTorque = 0.02;  // [N m]
  ArmHost host(Vec3::Zero());
  buildBall(host);
  auto& motor = host.add<btMultiBodySphericalJointMotor>(0, btScalar(kTorque / GetParam()));
  motor.setPositionTargetMultiDof(toBullet(Quat(Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()))),
                                  btVector3(1, 1, 1));
  motor.setMaxAppliedImpulseMultiDof(btVector3(1, 1, 1) * btScalar(kTorque / GetParam()));
  host.startApart();
  host.run(0.1, GetParam());
  const double before = speedOf(host).z();
  host.run(0.2, GetParam());
  const double inertia = static_cast<double>(host.arm().getLinkInertia(0).z()) + kMass * 0.1 * 0.1;
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(speedOf(host).z() - before, 0.2 * kTorque / inertia, byWidth(1e-7, 1e-4));
  EXPECT_NEAR(static_cast<double>(motor.getAppliedImpulse(2)), kTorque / GetParam(),
              byWidth(1e-7, 1e-4) * kTorque);
}

TEST_P(ArmConstraintsAtRates, JointFeedbackLeavesASphericalMotorOutAsInBullet) {
  std::array<btSpatialForceVector, 2> reactions;
  for (const bool has_site : {false, true}) {
    ArmHost host;
    buildBall(host);
    host.add<btMultiBodySphericalJointMotor>(0, btScalar(100.0 / GetParam()));
    reactions[has_site ? 1 : 0] = test::runForFeedback(host, GetParam(), has_site);
  }
  EXPECT_TRUE(test::areAlike(reactions[0], reactions[1]));
}

TEST_P(ArmConstraintsAtRates, ASphericalJointStopsAtItsLimits) {
  ArmHost host;
  buildBall(host);
  host.add<btMultiBodySphericalJointLimit>(0, btScalar(0.3), btScalar(0.4), btScalar(0.5),
                                           btScalar(100.0 / GetParam()));
  host.arm().setAngularDamping(btScalar(0.9));
  host.startApart();
  host.run(6.0, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 1U);
  // It falls about y, until its tilt is 0.4.
  const Vec3 z = turnOf(host) * Vec3::UnitZ();
  EXPECT_NEAR(std::asin(z.x()), 0.4, byWidth(1e-6, 1e-4));
}

TEST_P(ArmConstraintsAtRates, LimitsOfASphericalJointHoldWhateverItsTurn) {
  ArmHost host;
  buildBall(host);
  host.add<btMultiBodySphericalJointLimit>(0, btScalar(0.3), btScalar(0.4), btScalar(0.5),
                                           btScalar(100.0 / GetParam()));
  host.arm().getJointVelMultiDof(0)[0] = btScalar(3);
  host.arm().getJointVelMultiDof(0)[1] = btScalar(-2);
  host.arm().getJointVelMultiDof(0)[2] = btScalar(4);
  host.startApart();
  double farthest = 0.0;
  for (int i = 0; i < static_cast<int>(4.0 * GetParam()); ++i) {
    host.step(1.0 / GetParam());
    if (i < 3) continue;  // Bullet's own steps
    const Quat q = turnOf(host);
    const double turn = std::remainder(2.0 * std::atan2(q.z(), q.w()), 2.0 * M_PI);
    const Vec3 d = Eigen::AngleAxisd(-turn, Vec3::UnitZ()) * (q * Vec3::UnitZ());
    farthest = std::max({farthest, std::abs(std::atan2(-d.y(), d.z())) - 0.3,
                         std::abs(std::asin(d.x())) - 0.4, std::abs(turn) - 0.5});
  }
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_LT(farthest, byWidth(1e-5, 1e-4));
}

// Bullet solves this contact: the body has a law of friction that the island does not know.
TEST_P(ArmConstraintsAtRates, AStrangerOnALinkMeetsItsSphericalMotor) {
  ArmHost host;
  buildBall(host);
  host.add<btMultiBodySphericalJointMotor>(0, btScalar(100.0 / GetParam()));
  btRigidBody& cube = host.host.addCube(0.2, Vec3(0.12, 0.0, 0.042));
  cube.setAnisotropicFriction(btVector3(1, btScalar(0.5), 1));
  cube.setSleepingThresholds(0, 0);
  host.startApart();
  host.run(2.0, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_LT(turnOf(host).angularDistance(Quat::Identity()), 1e-3);
  EXPECT_NEAR(fromBullet(cube.getCenterOfMassPosition()).z(), 0.04, 1e-3);
}

TEST_P(ArmConstraintsAtRates, ASphericalMotorEndsWhenItIsRemoved) {
  ArmHost host;
  buildBall(host);
  host.add<btMultiBodySphericalJointMotor>(0, btScalar(100.0 / GetParam()));
  host.startApart();
  host.run(0.5, GetParam());
  EXPECT_LT(turnOf(host).angularDistance(Quat::Identity()), byWidth(1e-3, 1e-3));
  const double before = host.energy();
  host.remove(*host.constraints.back());
  host.run(0.5, GetParam());
  EXPECT_GT(turnOf(host).angularDistance(Quat::Identity()), 0.5);
  EXPECT_NEAR(host.energy(), before, byWidth(1e-6, 1e-2));
}

}  // namespace
}  // namespace tandem
