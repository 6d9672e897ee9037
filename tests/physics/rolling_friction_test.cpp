// Bullet's rolling and spinning friction in the island, and frictions that the island leaves to
// Bullet.

#include <cmath>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::kGravity;
using test::NeighbourScene;

constexpr double kRadius = 0.02;     // [m]
constexpr double kMass = 0.1;        // [kg]
constexpr double kSpeed = 0.3;       // [m/s]
constexpr double kRolling = 0.002;   // of the ball, in Bullet's unit
constexpr double kSpinning = 0.004;  // as well

/// A ball of the host on a floor, beside a shared cube.
struct Bowl : NeighbourScene {
  btRigidBody& ball;

  Bowl()
      : NeighbourScene(true),
        ball(rig.addBody(rig.makeShape<btSphereShape>(btScalar(kRadius)), kMass,
                         Vec3(0.0, 0.0, kRadius))) {
    addFloor();
    ball.setFriction(static_cast<btScalar>(std::sqrt(kFriction)));
    ball.setSleepingThresholds(0, 0);
    ball.setRollingFriction(static_cast<btScalar>(kRolling));
    ball.setSpinningFriction(static_cast<btScalar>(kSpinning));
    settings.max_neighbours = 4;
  }
  void share() { start(Vec3(0.06, 0.05, kHalf)); }
  /// Bullet's combination: the floor's friction scales the coefficient of the ball.
  [[nodiscard]] static double combine(double coefficient) {
    return std::sqrt(kFriction) * coefficient;
  }
};

// A torque c N stops a ball that rolls: v' = -c g / (7/5 R).
TEST(RollingFriction, StopsABallWhereTheFormulaSays) {
  Bowl scene;
  scene.share();
  scene.ball.setLinearVelocity(btVector3(btScalar(kSpeed), 0, 0));
  scene.ball.setAngularVelocity(btVector3(0, btScalar(kSpeed / kRadius), 0));
  scene.run(1.0 / 60.0);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  scene.run(2.0);
  const double braking = Bowl::combine(kRolling) * kGravity / (1.4 * kRadius);
  EXPECT_NEAR(NeighbourScene::positionOf(scene.ball).x(), kSpeed * kSpeed / (2.0 * braking), 1e-3);
  EXPECT_LT(NeighbourScene::velocityOf(scene.ball).norm(), 1e-9);
}

// w' = -c m g / I about the normal.
TEST(RollingFriction, SpinningFrictionBrakesATop) {
  Bowl scene;
  scene.share();
  constexpr double kSpin = 20.0, kTime = 0.1;
  scene.ball.setAngularVelocity(btVector3(0, 0, btScalar(kSpin)));
  scene.run(kTime);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  const double inertia = 0.4 * kRadius * kRadius;
  const double braking = Bowl::combine(kSpinning) * kGravity / inertia;
  const double left = static_cast<double>(scene.ball.getAngularVelocity().z());
  EXPECT_NEAR(left, kSpin - braking * kTime, 0.02 * kSpin);
}

TEST(RollingFriction, HoldsABallOnASlightSlope) {
  Bowl scene;
  scene.share();
  scene.run(0.1);
  const double most = Bowl::combine(kRolling) * kMass * kGravity / kRadius;
  const auto pushFor = [&](double force) {
    scene.run(0.5, 60.0, [&] {
      scene.ball.activate(true);
      scene.ball.applyCentralForce(btVector3(btScalar(force), 0, 0));
    });
    return NeighbourScene::positionOf(scene.ball).x();
  };
  EXPECT_NEAR(pushFor(0.9 * most), 0.0, 1e-5);
  EXPECT_GT(pushFor(1.5 * most), 0.005);
}

// The torque that held the ball went on for ever.
TEST(RollingFriction, LetsGoOfABallWhoseCoefficientIsTakenAway) {
  Bowl scene;
  scene.share();
  scene.run(0.1);
  const double force = 0.9 * Bowl::combine(kRolling) * kMass * kGravity / kRadius;
  const auto push = [&](double duration) {
    scene.run(duration, 60.0, [&] {
      scene.ball.activate(true);
      scene.ball.applyCentralForce(btVector3(btScalar(force), 0, 0));
    });
  };
  push(0.5);
  ASSERT_NEAR(NeighbourScene::positionOf(scene.ball).x(), 0.0, 1e-5);
  scene.ball.setRollingFriction(0);
  scene.ball.setSpinningFriction(0);
  push(0.5);
  const double acceleration = force / (1.4 * kMass);
  // A change acts from the first tick that begins after it.
  EXPECT_NEAR(NeighbourScene::velocityOf(scene.ball).x(), 0.5 * acceleration, 1e-3 * acceleration);
}

TEST(RollingFriction, BodiesWithOtherLawsStayBullets) {
  for (const bool is_anisotropic : {true, false}) {
    Bowl scene;
    scene.share();
    scene.run(1.0 / 60.0);
    ASSERT_EQ(scene.site->neighbourCount(), 1);
    if (is_anisotropic)
      scene.ball.setAnisotropicFriction(btVector3(1, btScalar(0.1), 1));
    else
      scene.ball.setContactStiffnessAndDamping(1000, 10);
    scene.run(0.5);
    EXPECT_EQ(scene.site->neighbourCount(), 0);
  }
}

}  // namespace
}  // namespace tandem
