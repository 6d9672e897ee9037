// Constraints between links, rigid bodies and the world near the hand do what Bullet says.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyGearConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>

#include "tandem/plugin/site.h"

#include "bullet_bridge/src/arms/arm_watch.h"
#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;
using test::byWidth;
using test::kMass;
using test::makeChain;

class ArmTiesAtRates : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, ArmTiesAtRates, ::testing::Values(60.0, 240.0));

btVector3 at(double x, double y = 0.0, double z = 0.0) { return toBullet(Vec3(x, y, z)); }
const btMatrix3x3 kStraight = btMatrix3x3::getIdentity();
btRigidBody* const kNoBody = nullptr;

/// A free multi-body without links.
void buildFree(ArmHost& host, const Vec3& p_W = Vec3::Zero()) {
  host.build({}, kMass, Vec3(0.1, 0.02, 0.02), p_W);
}

Vec3 basePosition(const ArmHost& host) { return fromBullet(host.arm().getBasePos()); }

TEST_P(ArmTiesAtRates, AFreeArmSwingsOnAPin) {
  ArmHost host;
  buildFree(host);
  host.add<btMultiBodyPoint2Point>(-1, kNoBody, at(-0.1), at(-0.1));
  host.startApart();
  host.step(1.0 / GetParam());  // Bullet's own, if it was not held at once
  const double before = host.energy();
  double worst = 0.0, open = 0.0;
  for (int i = 0; i < static_cast<int>(5.0 * GetParam()); ++i) {
    host.step(1.0 / GetParam());
    worst = std::max(worst, std::abs(host.energy() - before));
    const btVector3 pin = host.arm().localPosToWorld(-1, at(-0.1));
    open = std::max(open, static_cast<double>((pin - at(-0.1)).length()));
  }
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_LT(worst, byWidth(1e-6, 1e-2));
  EXPECT_LT(open, byWidth(1e-6, 1e-4));
}

/// Three links in a row whose end is pinned, as a loop.
template <typename Tie>
Vec3 runLoop(double rate, double duration, bool has_site, Tie tie) {
  ArmHost host;
  std::vector<ArmLinkPlan> plan = makeChain(3);
  host.build(plan);
  const double bent[] = {1.3, -0.9, -0.9};
  for (int i = 0; i < 3; ++i) host.arm().setJointPos(i, static_cast<btScalar>(bent[i]));
  host.showPose();
  tie(host);
  if (has_site) host.startApart();
  host.run(duration, rate);
  if (has_site) {
    EXPECT_EQ(host.site->counters().promoted, 3U);
  }
  return Vec3(host.q(0), host.q(1), host.q(2));
}

TEST_P(ArmTiesAtRates, AClosedLoopMovesAsInManyStepsOfBullet) {
  const auto pin = [](ArmHost& host) {
    const btVector3 end = host.arm().localPosToWorld(2, at(0.1));
    host.add<btMultiBodyPoint2Point>(2, kNoBody, at(0.1), end);
  };
  const Vec3 ours = runLoop(GetParam(), 1.0, true, pin);
  const Vec3 fine = runLoop(4000.0, 1.0, false, pin);
  // Bullet at 8 kHz is half as far from ours: what is apart is its own step's.
  EXPECT_LT((ours - fine).norm(), 5e-4);
}

TEST_P(ArmTiesAtRates, ARailGuidesTheEndOfAnArm) {
  const auto guide = [](ArmHost& host) {
    const btVector3 end = host.arm().localPosToWorld(2, at(0.1));
    const btMatrix3x3 frame = host.arm().localFrameToWorld(2, kStraight);
    // Along x of the world.
    const btVector3 along = host.arm().worldDirToLocal(2, btVector3(1, 0, 0));
    host.add<btMultiBodySliderConstraint>(2, kNoBody, at(0.1), end, kStraight, frame, along);
  };
  const Vec3 ours = runLoop(GetParam(), 0.3, true, guide);
  const Vec3 fine = runLoop(4000.0, 0.3, false, guide);
  EXPECT_LT((ours - fine).norm(), 5e-4);
  EXPECT_GT((fine - Vec3(1.3, -0.9, -0.9)).norm(), 0.1);
}

TEST_P(ArmTiesAtRates, AWeldCarriesABodyWithoutSag) {
  ArmHost host;
  host.build(makeChain(1));
  btMultiBodyJointMotor& motor = host.addMotor(0, 0.0, 100.0 / GetParam());
  btRigidBody& cube = host.host.addCube(0.3, Vec3(0.25, 0.0, 0.0));
  cube.setSleepingThresholds(0, 0);
  auto& weld =
      host.add<btMultiBodyFixedConstraint>(0, &cube, at(0.15), at(0.0), kStraight, kStraight);
  host.startApart();
  host.run(1.0, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 2U);
  EXPECT_LT((fromBullet(cube.getCenterOfMassPosition()) - Vec3(0.25, 0.0, 0.0)).norm(),
            byWidth(1e-3, 1e-3));
  const double weight = 0.3 * ArmHost::kGravity;
  const auto impulse = [&](int row) {
    return GetParam() * static_cast<double>(weld.getAppliedImpulse(row));
  };
  EXPECT_NEAR(impulse(2), -weight, byWidth(1e-3, 1e-2));
  EXPECT_NEAR(GetParam() * static_cast<double>(motor.getAppliedImpulse(0)),
              -(kMass * ArmHost::kGravity * 0.1 + weight * 0.25), byWidth(1e-3, 1e-2));
  const Vec3 before = fromBullet(cube.getCenterOfMassPosition());
  host.remove(weld);
  host.run(0.2, GetParam());
  EXPECT_NEAR(fromBullet(cube.getCenterOfMassPosition()).z() - before.z(),
              -0.5 * ArmHost::kGravity * 0.04, byWidth(1e-3, 3e-3) + 0.2 / GetParam());
}

/// Forces of all rows of a constraint that holds a free body against loads.
template <typename AddTie>
std::vector<double> findForces(double rate, bool has_site, AddTie add_tie) {
  ArmHost host;
  buildFree(host);
  btMultiBodyConstraint& tie = add_tie(host);
  if (has_site) host.startApart();
  for (int i = 0; i < static_cast<int>(rate); ++i) {
    host.arm().addBaseForce(at(0.5, 0.0, 1.0));
    host.arm().addBaseTorque(at(0.01, 0.02, -0.03));
    host.step(1.0 / rate);
  }
  std::vector<double> forces;
  for (int row = 0; row < tie.getNumRows(); ++row)
    forces.push_back(rate * static_cast<double>(tie.getAppliedImpulse(row)));
  return forces;
}

// In Bullet's rows, with Bullet's signs.
TEST_P(ArmTiesAtRates, ImpulsesAreToldAsInBullet) {
  const btMatrix3x3 frame(
      toBullet(Quat(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()))));
  const btVector3 pivot = at(-0.05, 0.01, 0.02);
  using AddTie = std::function<btMultiBodyConstraint&(ArmHost&)>;
  const AddTie ways[] = {[&](ArmHost& host) -> btMultiBodyConstraint& {
                           return host.add<btMultiBodyPoint2Point>(-1, kNoBody, at(0.0), at(0.0));
                         },
                         [&](ArmHost& host) -> btMultiBodyConstraint& {
                           return host.add<btMultiBodyFixedConstraint>(-1, kNoBody, pivot, pivot,
                                                                       frame, frame);
                         },
                         [&](ArmHost& host) -> btMultiBodyConstraint& {
                           return host.add<btMultiBodySliderConstraint>(-1, kNoBody, pivot, pivot,
                                                                        frame, frame, at(0.0, 1.0));
                         }};
  for (const AddTie& add_tie : ways) {
    const std::vector<double> ours = findForces(GetParam(), true, add_tie);
    const std::vector<double> fine = findForces(4000.0, false, add_tie);
    for (std::size_t row = 0; row < ours.size(); ++row)
      EXPECT_NEAR(ours[row], fine[row], byWidth(2e-3, 1e-2)) << ours.size() << " rows, row " << row;
  }
}

TEST_P(ArmTiesAtRates, APinGivesItsGreatestForce) {
  constexpr double kForce = 2.0;  // [N]
  ArmHost host;
  buildFree(host);
  auto& pin = host.add<btMultiBodyPoint2Point>(-1, kNoBody, at(0.0), at(0.0));
  pin.setMaxAppliedImpulse(static_cast<btScalar>(kForce / GetParam()));
  host.startApart();
  host.step(1.0 / GetParam());
  const double before = static_cast<double>(host.arm().getBaseVel().z());
  host.run(0.2, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(static_cast<double>(host.arm().getBaseVel().z()) - before,
              -0.2 * (ArmHost::kGravity - kForce / kMass), byWidth(1e-6, 1e-4));
  EXPECT_EQ(pin.getMaxAppliedImpulse(), static_cast<btScalar>(kForce / GetParam()));
}

// PyBullet's changeConstraint() moves a pivot of the world.
TEST_P(ArmTiesAtRates, AMovedPivotIsFollowedAsInBullet) {
  std::array<std::vector<Vec3>, 2> ways;
  for (const bool has_site : {false, true}) {
    ArmHost host;
    buildFree(host);
    auto& pin = host.add<btMultiBodyPoint2Point>(-1, kNoBody, at(0.0), at(0.0));
    if (has_site) host.startApart();
    host.run(0.2, GetParam());
    pin.setPivotInB(at(0.05, 0.0, 0.03));
    for (int i = 0; i < static_cast<int>(0.5 * GetParam()); ++i) {
      host.step(1.0 / GetParam());
      ways[has_site ? 1 : 0].push_back(basePosition(host));
    }
    EXPECT_LT((basePosition(host) - Vec3(0.05, 0.0, 0.03)).norm(), 1e-3);
  }
  double worst = 0.0;
  for (std::size_t i = 0; i < ways[0].size(); ++i)
    worst = std::max(worst, (ways[0][i] - ways[1][i]).norm());
  // The island closes a way by 1 - exp(-erp) in a step, Bullet by erp. A float's ticks lag by one.
  EXPECT_LT(worst, byWidth(0.08, 0.12) * 0.058);
}

// PyBullet's robots have a motor on each joint, and a host may pull their ends by constraints.
TEST_P(ArmTiesAtRates, AStrongPinMovesAnArmAgainstItsMotors) {
  constexpr double kTorque = 20.0, kForce = 500.0;  // [N m], [N]
  ArmHost host;
  host.build(makeChain(4));
  const double bent[] = {1.3, -0.9, -0.9, 0.5};
  for (int i = 0; i < 4; ++i) {
    host.arm().setJointPos(i, static_cast<btScalar>(bent[i]));
    host.addMotor(i, 0.0, kTorque / GetParam())
        .setPositionTarget(static_cast<btScalar>(bent[i]), btScalar(0.1));
  }
  host.showPose();
  const btVector3 place = host.arm().localPosToWorld(3, at(0.1)) + at(0.03, 0.0, 0.03);
  auto& pin = host.add<btMultiBodyPoint2Point>(3, kNoBody, at(0.1), place);
  pin.setMaxAppliedImpulse(static_cast<btScalar>(kForce / GetParam()));
  host.startApart();
  host.run(1.0, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 4U);
  EXPECT_LT((host.arm().localPosToWorld(3, at(0.1)) - place).length(), btScalar(1e-3));
  // The two motors that give way push with all they may, as in Bullet.
  const auto torque = [&](std::size_t i) {
    return GetParam() * static_cast<double>(host.constraints[i]->getAppliedImpulse(0));
  };
  EXPECT_NEAR(torque(0), kTorque, 1e-3);
  EXPECT_NEAR(torque(2), -kTorque, 1e-3);
}

TEST_P(ArmTiesAtRates, TwoArmsMeetInAPin) {
  const auto run = [&](double rate, bool has_site) {
    ArmHost host;
    const std::vector<ArmLinkPlan> plan = makeChain(2);
    host.build(plan);
    host.arm().setJointPos(0, btScalar(0.5));
    host.arm().setJointPos(1, btScalar(-0.3));
    host.showPose();
    btMultiBody& first = host.putAside();
    host.build(plan, 0.0, Vec3::Zero(), Vec3(0.8, 0.0, 0.0));
    host.arm().setJointPos(0, btScalar(M_PI - 0.4));
    host.showPose();
    const btVector3 tip = first.localPosToWorld(1, at(0.1));
    host.constraints.push_back(std::make_unique<btMultiBodyPoint2Point>(
        &first, 1, &host.arm(), 1, at(0.1), host.arm().worldPosToLocal(1, tip)));
    host.host.multi()->addMultiBodyConstraint(host.constraints.back().get());
    if (has_site) host.startApart();
    host.run(0.5, rate);
    if (has_site) {
      EXPECT_EQ(host.site->counters().promoted, 4U);
    }
    return Vec3(host.q(0), host.q(1), static_cast<double>(first.getJointPos(1)));
  };
  const Vec3 ours = run(GetParam(), true), fine = run(4000.0, false);
  EXPECT_LT((ours - fine).norm(), 1e-3);
  EXPECT_GT((fine - Vec3(M_PI - 0.4, 0.0, -0.3)).norm(), 0.1);
}

// A planar loop holds three of a weld's six ways already.
TEST_P(ArmTiesAtRates, AWeldedLoopStands) {
  ArmHost host;
  host.build(makeChain(3));
  const double bent[] = {1.3, -0.9, -0.9};
  for (int i = 0; i < 3; ++i) host.arm().setJointPos(i, static_cast<btScalar>(bent[i]));
  host.showPose();
  host.add<btMultiBodyFixedConstraint>(2, kNoBody, at(0.1), host.arm().localPosToWorld(2, at(0.1)),
                                       kStraight, host.arm().localFrameToWorld(2, kStraight));
  host.startApart();
  host.run(2.0, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 3U);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(host.q(i), bent[i], byWidth(1e-5, 1e-3));
}

// A pin beside the plane of a loop: nothing brings it there, and it does not pull for ever.
TEST_P(ArmTiesAtRates, AWayThatNothingClosesStaysOpen) {
  const auto pinBeside = [&](double way) {
    return [way, rate = GetParam()](ArmHost& host) {
      const btVector3 end = host.arm().localPosToWorld(2, at(0.1)) + at(0.0, way);
      auto& pin = host.add<btMultiBodyPoint2Point>(2, kNoBody, at(0.1), end);
      pin.setMaxAppliedImpulse(static_cast<btScalar>(500.0 / rate));
    };
  };
  const Vec3 closed = runLoop(GetParam(), 1.0, true, pinBeside(0.0));
  const Vec3 open = runLoop(GetParam(), 1.0, true, pinBeside(0.01));
  EXPECT_LT((closed - open).norm(), byWidth(1e-4, 1e-2));
}

TEST_P(ArmTiesAtRates, AWeldTurnsABodyBackAsInBullet) {
  std::array<std::vector<double>, 2> left;
  const btMatrix3x3 turned(toBullet(Quat(Eigen::AngleAxisd(1.0, Vec3::UnitZ()))));
  for (const bool has_site : {false, true}) {
    ArmHost host;
    buildFree(host);
    host.add<btMultiBodyFixedConstraint>(-1, kNoBody, at(0.0), at(0.0), kStraight, turned);
    if (has_site) host.startApart();
    for (int i = 0; i < 20; ++i) {
      host.run(0.05, GetParam());
      const btQuaternion turn = host.arm().getWorldToBaseRot().inverse();
      left[has_site ? 1 : 0].push_back(1.0 - static_cast<double>(2 * btAtan2(turn.z(), turn.w())));
    }
  }
  for (std::size_t i = 0; i < left[0].size(); ++i) EXPECT_NEAR(left[0][i], left[1][i], 0.06);
  EXPECT_NEAR(left[1].back(), 0.0, 1e-3);
}

/// A body on a link's rail, pushed along while the link turns: its place, and the link's angle.
Vec3 slideOnRail(double rate) {
  ArmHost host(Vec3::Zero());
  host.build(makeChain(1));
  btRigidBody& cube = host.host.addCube(0.2, Vec3(0.1, 0.0, 0.06));
  cube.setSleepingThresholds(0, 0);
  host.add<btMultiBodySliderConstraint>(0, &cube, at(0.0, 0.0, 0.06), at(0.0), kStraight, kStraight,
                                        at(1.0));
  host.startApart();
  for (int i = 0; i < static_cast<int>(0.5 * rate); ++i) {
    cube.applyCentralForce(at(0.3));
    host.arm().addJointTorque(0, btScalar(0.02));
    host.step(1.0 / rate);
  }
  EXPECT_EQ(host.site->counters().promoted, 2U);
  const Vec3 p_W = fromBullet(cube.getCenterOfMassPosition());
  return {p_W.x(), p_W.z(), host.q(0)};
}

/// The same body as a link of the arm, on a prismatic joint, in Bullet alone.
Vec3 slideAsLink(double rate) {
  ArmHost host(Vec3::Zero());
  std::vector<ArmLinkPlan> plan = makeChain(2);
  plan[1].joint = btMultibodyLink::ePrismatic;
  plan[1].axis = Vec3::UnitX();
  plan[1].mass = 0.2;
  plan[1].half = Vec3::Constant(0.02);
  plan[1].e = Vec3(0.0, 0.0, 0.06);
  plan[1].d = Vec3::Zero();
  host.build(plan);
  for (int i = 0; i < static_cast<int>(0.5 * rate); ++i) {
    host.arm().addLinkForce(1, at(0.3));
    host.arm().addJointTorque(0, btScalar(0.02));
    host.step(1.0 / rate);
  }
  const Vec3 p_W = host.linkPosition(1);
  return {p_W.x(), p_W.z(), host.q(0)};
}

// Bullet's own slider pulls the link where its pivot is, not where the body is, and is 3 cm off.
TEST_P(ArmTiesAtRates, ABodySlidesOnALinkAsOnAPrismaticJoint) {
  const Vec3 ours = slideOnRail(GetParam()), fine = slideAsLink(4000.0);
  EXPECT_LT((ours - fine).norm(), 1e-3);
  EXPECT_GT(ours.x(), 0.15);
}

TEST_P(ArmTiesAtRates, ASharedBodyBringsTheArmThatHoldsIt) {
  ArmHost host;
  host.build(makeChain(1));
  host.addMotor(0, 0.0, 100.0 / GetParam());
  btRigidBody& cube = host.host.addCube(0.3, Vec3(0.25, 0.0, 0.0));
  host.add<btMultiBodyFixedConstraint>(0, &cube, at(0.15), at(0.0), kStraight, kStraight);
  SiteSettings settings;
  settings.peers = 1;
  host.start(settings);
  host.site->share(cube);
  host.run(0.5, GetParam());
  EXPECT_EQ(host.site->counters().promoted, 1U);
  EXPECT_NEAR(fromBullet(cube.getCenterOfMassPosition()).z(), 0.0, 1e-3);
}

TEST(ArmTies, AreGivenBackWithTheArm) {
  ArmHost host;
  host.build(makeChain(2));
  btRigidBody& cube = host.host.addCube(0.3, Vec3(0.45, 0.0, 0.0));
  auto& weld =
      host.add<btMultiBodyFixedConstraint>(1, &cube, at(0.15), at(0.0), kStraight, kStraight);
  weld.setMaxAppliedImpulse(btScalar(7));
  host.putHandBeside();
  host.start();
  host.run(0.1, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 3U);
  EXPECT_EQ(weld.getMaxAppliedImpulse(), btScalar(7));
  host.device.sample.hip.p_W = Vec3(0.0, 3.0, 0.0);
  host.run(0.3, 60.0);
  EXPECT_EQ(host.site->counters().demoted, 3U);
  EXPECT_EQ(weld.getMaxAppliedImpulse(), btScalar(7));
  EXPECT_LT((cube.getCenterOfMassPosition() - host.arm().localPosToWorld(1, at(0.15))).length(),
            btScalar(0.05));
}

// Its solver and its error contradict each other there.
TEST(ArmTies, WithATurnedFrameOnARigidBodyStayBullets) {
  ArmHost host;
  host.build(makeChain(2));
  btRigidBody& cube = host.host.addCube(0.3, Vec3(0.45, 0.0, 0.0));
  const btMatrix3x3 turned(toBullet(Quat(Eigen::AngleAxisd(1.0, Vec3::UnitZ()))));
  host.add<btMultiBodyFixedConstraint>(1, &cube, at(0.15), at(0.0), turned, turned);
  host.putHandBeside();
  host.start();
  host.run(0.1, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 0U);
  const std::vector<std::string> warnings = host.site->warnings();
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
    return line.find("turned frame") != std::string::npos;
  }));
}

// A gear couples two joints, and so up to four links.
// Bullet alone reads before the start of its list of bodies there, so the world is not stepped.
TEST(ArmTies, ToWhatStandsStayBullets) {
  ArmHost host;
  host.build(makeChain(2));
  btRigidBody& cube = host.host.addCube(0.2, Vec3(0.4, 0.0, 0.0));
  host.add<btMultiBodyPoint2Point>(1, &cube, at(0.1), at(-0.05));
  const auto findObstacle = [&] { return findObstacleToHold(*host.host.multi(), host.arm()); };
  EXPECT_EQ(findObstacle(), nullptr);
  cube.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  ASSERT_NE(findObstacle(), nullptr);
  EXPECT_NE(std::string(findObstacle()).find("static or kinematic body"), std::string::npos);
  cube.setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  EXPECT_NE(findObstacle(), nullptr);
}

TEST(ArmTies, GearsStayBullets) {
  ArmHost host;
  host.build(makeChain(2));
  host.constraints.push_back(std::make_unique<btMultiBodyGearConstraint>(
      &host.arm(), 0, &host.arm(), 1, at(0.0), at(0.0), kStraight, kStraight));
  host.host.multi()->addMultiBodyConstraint(host.constraints.back().get());
  host.putHandBeside();
  host.start();
  host.run(0.1, 60.0);
  EXPECT_EQ(host.site->counters().promoted, 0U);
  const std::vector<std::string> warnings = host.site->warnings();
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
    return line.find("gear") != std::string::npos;
  }));
}

TEST(ArmTies, BringWhatTheyConnectOrLeaveAllToBullet) {
  for (const bool is_known : {true, false}) {
    ArmHost host;
    host.build(makeChain(2));
    btRigidBody& cube = host.host.addCube(0.3, Vec3(1.0, 0.0, 0.0));
    if (!is_known) cube.setAnisotropicFriction(btVector3(1, btScalar(0.5), 1));
    host.add<btMultiBodyPoint2Point>(1, &cube, at(0.1), at(-0.6));
    host.putHandBeside();
    host.start();
    host.run(0.1, 60.0);
    EXPECT_EQ(host.site->counters().promoted, is_known ? 3U : 0U);
    const std::vector<std::string> warnings = host.site->warnings();
    const bool warns = std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
      return line.find("connect") != std::string::npos;
    });
    EXPECT_EQ(warns, !is_known);
  }
}

}  // namespace
}  // namespace tandem
