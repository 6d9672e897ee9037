// Joints of multi-bodies near the hand: their limits, motors and torques do what Bullet says.

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/island_counters.h"
#include "tandem/plugin/site.h"

#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;
using test::byWidth;
using test::kMass;
using test::makeChain;

class ArmJointsAtRates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, ArmJointsAtRates, ::testing::Values(60.0, 240.0, 1000.0));

TEST_P(ArmJointsAtRates, AJointStopsAtItsLimit) {
  ArmHost host;
  host.build(makeChain(1));
  host.addLimit(0, -0.5, 0.5);
  host.putHandBeside();
  host.start();
  double farthest = 0.0;
  for (int i = 0; i < static_cast<int>(2.0 * GetParam()); ++i) {
    host.step(1.0 / GetParam());
    farthest = std::max(farthest, std::abs(host.q(0)));
  }
  EXPECT_LT(farthest, 0.5 + byWidth(1e-7, 1e-5));
  EXPECT_NEAR(host.q(0), 0.5, byWidth(1e-7, 1e-5));
}

TEST_P(ArmJointsAtRates, AMotorReachesItsSpeedByItsForce) {
  constexpr double kSpeed = 0.7, kForce = 5.0;  // [m/s], [N]
  ArmHost host(Vec3::Zero());
  ArmLinkPlan slide;
  slide.joint = btMultibodyLink::ePrismatic;
  slide.axis = Vec3::UnitX();
  slide.d = Vec3::Zero();
  host.build({slide});
  btMultiBodyJointMotor& motor = host.addMotor(0, kSpeed, kForce / GetParam());
  host.device.sample.hip.p_W = Vec3(0.3, 0.05, 0.0);
  SiteSettings settings;
  settings.host_stall = 1.0;  // the drawer stays near
  host.start(settings);
  host.step(1.0 / GetParam());
  EXPECT_NEAR(static_cast<double>(motor.getAppliedImpulse(0)), kForce / GetParam(),
              byWidth(1e-9, 1e-5) * kForce);
  for (int i = 1; i < static_cast<int>(std::lround(0.5 * GetParam())); ++i)
    host.step(1.0 / GetParam());
  const double until = kSpeed * kMass / kForce;
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(host.q(0), kSpeed * (0.5 - 0.5 * until), byWidth(1e-5, 2e-5));
  EXPECT_NEAR(host.u(0), kSpeed, byWidth(1e-9, 1e-5));
  EXPECT_NEAR(static_cast<double>(motor.getMaxAppliedImpulse()), kForce / GetParam(), 1e-6);
}

TEST_P(ArmJointsAtRates, AMotorAtItsBoundTellsIt) {
  constexpr double kTorque = 0.2;  // [N m]: too weak for the link
  ArmHost host;
  host.build(makeChain(1));
  btMultiBodyJointMotor& motor = host.addMotor(0, 0.0, kTorque / GetParam());
  host.putHandBeside();
  host.start();
  host.run(0.2, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(static_cast<double>(motor.getAppliedImpulse(0)), -kTorque / GetParam(),
              byWidth(1e-9, 1e-5) * kTorque);
}

// PyBullet's position control: gains of 0.1 and 1.
TEST_P(ArmJointsAtRates, AMotorHoldsALinkInPlace) {
  ArmHost host;
  host.build(makeChain(2));
  for (int i = 0; i < 2; ++i)
    host.addMotor(i, 0.0, 100.0 / GetParam()).setPositionTarget(btScalar(0.3), btScalar(0.1));
  host.putHandBeside();
  host.start();
  host.run(3.0, GetParam());
  EXPECT_NEAR(host.q(0), 0.3, byWidth(1e-7, 1e-5));
  EXPECT_NEAR(host.q(1), 0.3, byWidth(1e-7, 1e-5));
}

// A velocity gain below 1 makes a spring with a damper out of the motor.
TEST_P(ArmJointsAtRates, ASoftMotorSagsAsInBullet) {
  std::array<double, 2> q{};
  for (const bool has_site : {false, true}) {
    ArmHost host;
    host.build(makeChain(1));
    btMultiBodyJointMotor& motor = host.addMotor(0, 0.0, 100.0 / GetParam());
    motor.setPositionTarget(0, btScalar(4.0 / GetParam()));
    motor.setVelocityTarget(0, btScalar(20.0 / GetParam()));
    host.putHandBeside();
    if (has_site) host.start();
    host.run(3.0, GetParam());
    q[has_site ? 1 : 0] = host.q(0);
  }
  EXPECT_GT(q[0], 0.01);
  EXPECT_NEAR(q[1], q[0], 1e-3 * q[0] + byWidth(0.0, 1e-5));
}

TEST_P(ArmJointsAtRates, JointFeedbackLeavesMotorsAndLimitsOutAsInBullet) {
  for (const bool has_motor : {false, true}) {
    std::array<btSpatialForceVector, 2> reactions;
    for (const bool has_site : {false, true}) {
      ArmHost host;
      host.build(makeChain(1));
      host.arm().setAngularDamping(btScalar(0.9));
      if (has_motor)
        host.addMotor(0, 0.0, 100.0 / GetParam());
      else
        host.addLimit(0, -0.01, 0.01);
      reactions[has_site ? 1 : 0] = test::runForFeedback(host, GetParam(), has_site);
    }
    EXPECT_TRUE(test::areAlike(reactions[0], reactions[1])) << has_motor;
  }
}

TEST_P(ArmJointsAtRates, TorqueOfTheHostTurnsAJoint) {
  constexpr double kTorque = 0.02;  // [N m]
  ArmHost host(Vec3::Zero());
  host.build(makeChain(1));
  host.putHandBeside();
  host.start();
  host.run(0.1, GetParam());
  for (int i = 0; i < static_cast<int>(std::lround(0.5 * GetParam())); ++i) {
    host.arm().addJointTorque(0, btScalar(kTorque));
    host.step(1.0 / GetParam());
  }
  const double inertia = static_cast<double>(host.arm().getLinkInertia(0).y()) + kMass * 0.1 * 0.1;
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(host.u(0), 0.5 * kTorque / inertia, byWidth(1e-9, 1e-5));
  EXPECT_NEAR(host.q(0), 0.125 * kTorque / inertia, byWidth(1e-9, 1e-4));
}

// Forces on links, and torques of joints with several degrees of freedom.
TEST_P(ArmJointsAtRates, ForcesOfTheHostMoveLinks) {
  ArmHost host(Vec3::Zero());
  std::vector<ArmLinkPlan> plan(3);
  for (ArmLinkPlan& link : plan) link.parent = -1;
  plan[0].joint = btMultibodyLink::ePrismatic;
  plan[0].d = Vec3::Zero();
  plan[1].joint = btMultibodyLink::eSpherical;
  plan[1].e = Vec3(0.0, 0.3, 0.0);
  plan[2].joint = btMultibodyLink::ePlanar;
  plan[2].axis = Vec3::UnitZ();
  plan[2].d = Vec3::Zero();
  plan[2].e = Vec3(0.0, -0.3, 0.0);
  host.build(plan);
  host.device.sample.hip.p_W = Vec3(0.0, 0.15, 0.1);
  SiteSettings settings;
  settings.host_stall = 0.2;  // all are near
  host.start(settings);
  host.run(0.1, GetParam());
  for (int i = 0; i < static_cast<int>(std::lround(0.5 * GetParam())); ++i) {
    host.arm().addLinkForce(0, btVector3(0, 1, 0));
    host.arm().addJointTorqueMultiDof(1, 0, btScalar(0.001));  // about the link's own length
    host.arm().addJointTorqueMultiDof(2, 0, btScalar(0.01));
    host.step(1.0 / GetParam());
  }
  const auto velocity = [&](int link) {
    return static_cast<double>(host.arm().getJointVelMultiDof(link)[0]);
  };
  const auto inertia = [&](int link, int axis) {
    return static_cast<double>(host.arm().getLinkInertia(link)[axis]);
  };
  EXPECT_EQ(host.site->counters().promoted, 3U);
  EXPECT_NEAR(velocity(0), 0.5 / kMass, byWidth(1e-9, 1e-5));
  EXPECT_NEAR(velocity(1), 0.5 * 0.001 / inertia(1, 0), byWidth(1e-7, 1e-4));
  EXPECT_NEAR(velocity(2), 0.5 * 0.01 / inertia(2, 2), byWidth(1e-7, 1e-4));
}

// A motor whose speed falls with the way that is left is followed within a step, not mended after
// it: that took five tries a tick. The joint's angle then decays as Bullet's motor asks for.
TEST(ArmJoints, AMotorThatSeeksAPlaceTakesOneStepATick) {
  constexpr double kGain = 0.05, kStart = 0.5;  // part of the way in a host's step; [rad]
  ArmHost host(Vec3::Zero());
  host.build(makeChain(3));
  for (int i = 0; i < 3; ++i) {
    host.addMotor(i, 0.0, 1000.0 / 60.0).setPositionTarget(0, btScalar(kGain));
    host.arm().setJointPos(i, btScalar(kStart));
  }
  host.showPose();
  host.putHandBeside();
  host.start();
  host.run(0.1, 60.0);
  const IslandCounters before = host.site->islandCounters();
  const double angle = host.q(0);
  host.run(0.5, 60.0);
  const IslandCounters after = host.site->islandCounters();
  // A host step ends within a tick.
  EXPECT_LT(after.rigid_steps - before.rigid_steps, 600U);
  EXPECT_GT(after.rigid_steps - before.rigid_steps, 499U);
  EXPECT_NEAR(host.q(0), angle * std::exp(-kGain * 60.0 * 0.5), byWidth(1e-6, 1e-4));
}

// Bullet solves this contact: the body has a law of friction that the island does not know.
TEST(ArmJoints, AStrangerOnALinkMeetsItsMotor) {
  ArmHost host;
  host.build(makeChain(1));
  btMultiBodyJointMotor& motor = host.addMotor(0, 0.0, 100.0 / 60.0);
  btRigidBody& cube = host.host.addCube(0.2, Vec3(0.12, 0.0, 0.042));
  cube.setAnisotropicFriction(btVector3(1, btScalar(0.5), 1));
  cube.setSleepingThresholds(0, 0);
  host.putHandBeside();
  host.start();
  host.run(2.0, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_LT(std::abs(host.q(0)), 1e-4);
  EXPECT_NEAR(fromBullet(cube.getCenterOfMassPosition()).z(), 0.04, 1e-4);
  const double torque = ArmHost::kGravity * (kMass * 0.1 + 0.2 * 0.12);
  EXPECT_NEAR(60.0 * static_cast<double>(motor.getAppliedImpulse(0)), -torque, 0.01 * torque);
  EXPECT_EQ(motor.getMaxAppliedImpulse(), btScalar(100.0 / 60.0));
}

}  // namespace
}  // namespace tandem
