#include <limits>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/bodies/haptic_body.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;

constexpr double kMass = 0.25;  // [kg], exact in binary, so impulses are exact too

/// Changes that the pre-tick sees in a whole step, sub-step by sub-step.
std::vector<HostChange> takeDuringStep(BulletRig& rig, HapticBody& body, int sub_steps) {
  constexpr double kSubStep = 1.0 / 256.0;
  std::vector<HostChange> changes;
  test::Listener listener(
      [&](double h) {
        changes.push_back(body.takeHostChanges(h));
        body.handOff(body.state(), h);
      },
      [&](double) { body.restore(); });
  const HostWorld attached(rig.world, listener);
  rig.world.stepSimulation(static_cast<btScalar>(sub_steps * kSubStep), sub_steps,
                           static_cast<btScalar>(kSubStep));
  return changes;
}

/// A body that the island holds still, with weight and a state in which rotation matters.
struct HostChanges : ::testing::Test {
  HostChanges()
      : cube(rig.addBody(
            rig.makeShape<btBoxShape>(btVector3(btScalar(0.01), btScalar(0.02), btScalar(0.04))),
            kMass)),
        body(rig.world, cube) {
    body.setState({Vec3(0.5, 1, -0.25), test::turn(0.7, {1, 2, 3}), Vec3::Zero(), Vec3::Zero()});
  }
  HostChange take() { return takeDuringStep(rig, body, 1).front(); }
  static void expectNothing(const HostChange& change) {
    EXPECT_EQ(change.impulse_W, Vec3::Zero());
    EXPECT_EQ(change.angular_impulse_W, Vec3::Zero());
    EXPECT_FALSE(change.moved);
    EXPECT_EQ(change.offset_W, Vec3::Zero());
  }

  BulletRig rig{Vec3(0, -9.81, 0)};
  btRigidBody& cube;
  HapticBody body;
};

TEST_F(HostChanges, AreNoneWhereTheHostDidNothing) {
  expectNothing(take());
  for (const HostChange& change : takeDuringStep(rig, body, 4)) expectNothing(change);
}

TEST_F(HostChanges, ReportAForceInEachSubStepInWhichBulletWouldApplyIt) {
  cube.applyForce(btVector3(2, 0, 0), btVector3(0, 0, btScalar(0.5)));
  const auto changes = takeDuringStep(rig, body, 4);
  ASSERT_EQ(changes.size(), 4u);
  for (const HostChange& change : changes) {
    EXPECT_EQ(change.f_W, Vec3(2, 0, 0));
    EXPECT_EQ(change.t_W, Vec3(0, 1, 0));
    EXPECT_EQ(change.impulse_W, Vec3(2.0 / 256, 0, 0));
    EXPECT_EQ(change.angular_impulse_W, Vec3(0, 1.0 / 256, 0));
    EXPECT_FALSE(change.moved);
  }
  for (const HostChange& change : takeDuringStep(rig, body, 2)) expectNothing(change);
}

// Bullet gives weight once for all sub-steps. A body that parked between two and woke had it twice.
TEST_F(HostChanges, AreNoneForABodyThatParksAndWakesBetweenSubSteps) {
  constexpr double kSubStep = 1.0 / 256.0;
  std::vector<HostChange> changes;
  bool is_undisturbed = false;
  test::Listener listener(
      [&](double h) {
        if (body.isParked()) {
          is_undisturbed = body.isUndisturbed();
          body.unpark();
        }
        changes.push_back(body.takeHostChanges(h));
        body.handOff(body.state(), h);
      },
      [&](double) {
        body.restore();
        if (changes.size() == 2) body.park();
      });
  const HostWorld attached(rig.world, listener);
  rig.world.stepSimulation(static_cast<btScalar>(4 * kSubStep), 4, static_cast<btScalar>(kSubStep));
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_TRUE(is_undisturbed);
  for (const HostChange& change : changes) expectNothing(change);
}

TEST_F(HostChanges, KeepAForceThatAnActionGivesABodyThatParks) {
  constexpr double kSubStep = 1.0 / 256.0;
  std::vector<HostChange> changes;
  test::Listener listener(
      [&](double h) {
        if (body.isParked() && !body.isUndisturbed()) body.unpark();
        if (!body.isParked()) changes.push_back(body.takeHostChanges(h));
        if (!body.isParked()) body.handOff(body.state(), h);
      },
      [&](double) {
        body.restore();
        if (changes.size() > 1) return;
        cube.applyCentralForce(btVector3(2, 0, 0));
        body.park();
      });
  const HostWorld attached(rig.world, listener);
  rig.world.stepSimulation(static_cast<btScalar>(2 * kSubStep), 2, static_cast<btScalar>(kSubStep));
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_LT((changes.back().f_W - Vec3(2, 0, 0)).norm(), byWidth(1e-15, 1e-6));
}

TEST_F(HostChanges, ReportAnImpulseOnce) {
  cube.applyCentralImpulse(btVector3(btScalar(0.5), btScalar(-0.25), 1));
  const HostChange change = take();
  EXPECT_EQ(change.impulse_W, Vec3(0.5, -0.25, 1));
  EXPECT_EQ(change.f_W, Vec3::Zero());
  expectNothing(take());
}

TEST_F(HostChanges, ReportATorqueImpulseWithTheInertiaOfTheTurnedBody) {
  cube.applyTorqueImpulse(btVector3(btScalar(1e-4), btScalar(-2e-4), btScalar(3e-4)));
  const Vec3 taken = take().angular_impulse_W;
  EXPECT_LT((taken - Vec3(1e-4, -2e-4, 3e-4)).norm(), byWidth(1e-18, 1e-9));
  expectNothing(take());
}

TEST_F(HostChanges, ReportAVelocitySetByTheHost) {
  cube.setLinearVelocity(btVector3(2, 0, -1));
  EXPECT_EQ(take().impulse_W, kMass * Vec3(2, 0, -1));
  cube.setLinearVelocity(btVector3(0, 0, 0));
  EXPECT_EQ(take().impulse_W, kMass * Vec3(-2, 0, 1));
}

TEST_F(HostChanges, ReportATeleportOnceWithOffsetAndRotation) {
  const Quat turned = test::turn(-1.1, {0, 1, 1});
  cube.setCenterOfMassTransform(toBullet(Vec3(-1.5, 3, 0.75), turned));
  const HostChange change = take();
  EXPECT_TRUE(change.moved);
  EXPECT_EQ(change.offset_W, Vec3(-2, 2, 1));
  const Quat reached = change.rotation_W * test::turn(0.7, {1, 2, 3});
  EXPECT_LT(reached.angularDistance(turned), byWidth(1e-14, 1e-6));
  EXPECT_EQ(change.impulse_W, Vec3::Zero());
  expectNothing(take());
}

TEST_F(HostChanges, SeeATeleportByOneUnitInTheLastPlace) {
  btTransform pose = cube.getWorldTransform();
  pose.getOrigin().setX(std::nextafter(pose.getOrigin().x(), btScalar(2)));
  cube.setWorldTransform(pose);
  const HostChange change = take();
  EXPECT_TRUE(change.moved);
  EXPECT_EQ(change.offset_W.x(), 0.5 * static_cast<double>(SIMD_EPSILON));
}

TEST_F(HostChanges, AreNoneWhereTheHostRenewsTheWeightInItsPreTick) {
  // The usual work-around for forces that stay over sub-steps. Our callback runs after it.
  rig.world.setInternalTickCallback(
      [](btDynamicsWorld* world, btScalar) {
        auto* host = static_cast<btDiscreteDynamicsWorld*>(world);
        host->clearForces();
        host->applyGravity();
      },
      nullptr, true);
  for (const HostChange& change : takeDuringStep(rig, body, 4)) expectNothing(change);
}

TEST_F(HostChanges, AreTakenAsKnownByRemember) {
  cube.applyCentralImpulse(btVector3(1, 0, 0));
  cube.setWorldTransform(toBullet(Vec3(9, 9, 9), Quat::Identity()));
  body.remember();
  expectNothing(take());
}

TEST_F(HostChanges, ThatAreNotFiniteAreDropped) {
  cube.setLinearVelocity(btVector3(std::numeric_limits<btScalar>::quiet_NaN(), 0, 0));
  expectNothing(take());
}

TEST_F(HostChanges, ImpulseModeGivesForceTimesStep) {
  body.applyWrench(Vec3(2, 0, -4), Vec3(1e-4, 0, 0), 1.0 / 256.0);
  EXPECT_EQ(body.state().v_W, Vec3(2, 0, -4) / kMass / 256.0);
  const Vec3 taken = take().angular_impulse_W;
  EXPECT_LT((taken - Vec3(1e-4, 0, 0) / 256.0).norm(), byWidth(1e-20, 1e-11));
}

}  // namespace
}  // namespace tandem
