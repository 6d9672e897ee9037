#include <cmath>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/bodies/haptic_body.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;

/// A motion that no force law gives. It only has to be reproduced.
RigidState computeMotion(double t) {
  RigidState state;
  state.p_W = Vec3(0.1 * std::sin(7 * t), 0.2 + 0.05 * std::cos(11 * t), 0.3 * t);
  state.v_W = Vec3(0.7 * std::cos(7 * t), -0.55 * std::sin(11 * t), 0.3);
  state.q_WB = test::turn(3.0 * t, {1, 2, -1}) * test::turn(0.4 * std::sin(5 * t), {0, 1, 1});
  state.w_W = Vec3(1, -2, 0.5);
  return state;
}

double angleBetween(const Quat& a, const Quat& b) { return 2.0 * (a * b.conjugate()).vec().norm(); }

class HandOff : public ::testing::TestWithParam<double> {};

// A free body is exactly where the island put it after Bullet's own integration. Weight, a constant
// host force and torque, and Bullet's gyroscopic term act on it.
TEST_P(HandOff, CarriesAFreeBodyExactly) {
  const double dt = 1.0 / GetParam();
  BulletRig rig(Vec3(0, -9.81, 0));
  btRigidBody& cube = rig.addBody(
      rig.makeShape<btBoxShape>(btVector3(btScalar(0.01), btScalar(0.02), btScalar(0.04))), 0.3);
  ASSERT_NE(cube.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY, 0);
  HapticBody body(rig.world, cube, 0.5);
  body.setState(computeMotion(0));
  int step = 0;
  HostChange residual;
  RigidState by_bullet;
  test::Listener listener(
      [&](double h) {
        static_cast<void>(body.takeHostChanges(h));
        body.handOff(computeMotion((step + 1) * dt), h);
      },
      [&](double) {
        by_bullet = body.state();
        residual = body.restore();
        ++step;
      });
  const HostWorld attached(rig.world, listener);

  // Rounding of the pose, and of v dt added to it.
  const double tolerance = byWidth(1e-14, 1e-6);
  for (int i = 0; i < 200; ++i) {
    cube.applyCentralForce(btVector3(3, -2, 1));
    cube.applyTorque(btVector3(btScalar(0.01), btScalar(0.02), btScalar(-0.01)));
    rig.step(dt);
    const RigidState expected = computeMotion(step * dt);
    EXPECT_LT((by_bullet.p_W - expected.p_W).norm(), tolerance) << "step " << i;
    EXPECT_LT(angleBetween(by_bullet.q_WB, expected.q_WB), tolerance) << "step " << i;
    EXPECT_EQ(residual.impulse_W, Vec3::Zero()) << "step " << i;
    EXPECT_EQ(residual.angular_impulse_W, Vec3::Zero()) << "step " << i;
    const RigidState restored = body.state();
    EXPECT_LT((restored.p_W - expected.p_W).norm(), byWidth(1e-16, 1e-7));
    EXPECT_LT((restored.v_W - expected.v_W).norm(), byWidth(1e-15, 1e-7));
    EXPECT_LT((restored.w_W - expected.w_W).norm(), byWidth(1e-15, 1e-7));
    EXPECT_LT(angleBetween(restored.q_WB, expected.q_WB), byWidth(1e-14, 1e-6));
  }
  EXPECT_NE(cube.getFlags() & BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY, 0);
}
INSTANTIATE_TEST_SUITE_P(HostRates, HandOff, ::testing::Values(60.0, 240.0, 1000.0));

// The host's step goes on with another share of the mass: nothing of it looks like a push.
TEST(HandOff, AnotherMassShareIsNoChangeByTheHost) {
  BulletRig rig(Vec3(0, -9.81, 0));
  btRigidBody& cube = rig.addCube(0.3);
  HapticBody body(rig.world, cube, 0.5);
  RigidState falling;
  const auto fall = [&](double dt) {
    falling.p_W += dt * falling.v_W + 0.5 * dt * dt * Vec3(0, -9.81, 0);
    falling.v_W += dt * Vec3(0, -9.81, 0);
  };
  int step = 0;
  test::Listener listener(
      [&](double dt) {
        const HostChange change = body.takeHostChanges(dt);
        EXPECT_LT(change.impulse_W.norm(), byWidth(1e-14, 1e-7)) << step;
        if (step == 3) body.setMassShare(1.0 / 3.0);
        if (step == 6) body.setMassShare(1.0);
        fall(dt);
        body.handOff(falling, dt);
      },
      [&](double) {
        EXPECT_LT(body.restore().impulse_W.norm(), byWidth(1e-14, 1e-7)) << step;
        ++step;
      });
  const HostWorld attached(rig.world, listener);
  for (int i = 0; i < 10; ++i) {
    rig.step(1.0 / 60.0);
    const double share = i < 3 ? 0.5 : i < 6 ? 1.0 / 3.0 : 1.0;
    EXPECT_NEAR(body.mass(), 0.3 * share, byWidth(1e-15, 1e-7));
    EXPECT_NEAR(body.gravityForce().y(), -9.81 * 0.3 * share, byWidth(1e-14, 1e-6));
    EXPECT_TRUE(body.isAsHeld());
  }
}

// Even a step that turns the body further than Bullet can integrate ends at the island's pose.
TEST(HandOff, ReachesPosesBeyondBulletsLargestTurnPerStep) {
  BulletRig rig;
  HapticBody body(rig.world, rig.addCube(0.3));
  const RigidState end{Vec3(0, 0, 1), test::turn(3.0, {0, 0, 1}), Vec3::Zero(), Vec3::Zero()};
  test::Listener listener([&](double h) { body.handOff(end, h); }, [&](double) { body.restore(); });
  const HostWorld attached(rig.world, listener);
  rig.step(1.0 / 60.0);
  EXPECT_LT(angleBetween(body.state().q_WB, end.q_WB), byWidth(1e-14, 1e-6));
}

TEST(HandOff, KeepsMotionStateWithTheBody) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  btDefaultMotionState motion_state;
  cube.setMotionState(&motion_state);
  HapticBody body(rig.world, cube);
  double t = 0;
  test::Listener listener(
      [&](double h) {
        t += h;
        body.handOff(computeMotion(t), h);
      },
      [&](double) { body.restore(); });
  const HostWorld attached(rig.world, listener);
  for (int i = 0; i < 20; ++i) {
    rig.step(1.0 / 240.0);
    btTransform shown;
    motion_state.getWorldTransform(shown);
    EXPECT_LT((fromBullet(shown.getOrigin()) - computeMotion(t).p_W).norm(), byWidth(1e-14, 1e-6));
    EXPECT_EQ(fromBullet(cube.getInterpolationLinearVelocity()), body.state().v_W);
    EXPECT_EQ(fromBullet(cube.getInterpolationAngularVelocity()), body.state().w_W);
  }
}

TEST(HandOff, AdditionalDampingOfTheBodyIsNoImpulseOfTheSolver) {
  BulletRig rig;
  btCollisionShape& shape = rig.makeShape<btSphereShape>(btScalar(0.02));
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(0.1), nullptr, &shape, btVector3(1, 1, 1));
  info.m_additionalDamping = true;
  rig.bodies.push_back(std::make_unique<btRigidBody>(info));
  rig.world.addRigidBody(rig.bodies.back().get());
  HapticBody body(rig.world, *rig.bodies.back());
  const RigidState end{Vec3(1e-4, 0, 0), Quat::Identity(), Vec3(0.01, 0, 0), Vec3::Zero()};
  HostChange residual;
  test::Listener listener([&](double h) { body.handOff(end, h); },
                          [&](double) { residual = body.restore(); });
  const HostWorld attached(rig.world, listener);
  rig.step(0.01);
  EXPECT_EQ(residual.impulse_W, Vec3::Zero());
  EXPECT_NEAR(body.state().p_W.x(), 1e-4, byWidth(1e-18, 1e-11));
}

// The solver finds an impulse that `end` holds already, and the pose that it leads to.
TEST(HandOff, TellsThePoseThatTheSolverLedTo) {
  constexpr double kStep = 1.0 / 60.0, kMass = 0.2;
  BulletRig rig(Vec3(0.0, 0.0, -9.81));
  btRigidBody& ours = rig.addCube(kMass, 0.02, Vec3::Zero());
  btPoint2PointConstraint pin(ours, btVector3(0, 0, 0));
  rig.world.addConstraint(&pin);
  HapticBody body(rig.world, ours);
  const double weight = kMass * 9.81;
  // Without the pin it falls; a foreseen force holds it in part.
  for (const double held : {0.0, 0.5, 1.0}) {
    const double fall = (held - 1.0) * 9.81;
    RigidState end;
    end.v_W.z() = fall * kStep;
    end.p_W.z() = 0.5 * fall * kStep * kStep;
    const Momentum mean{Vec3(0.0, 0.0, 0.5 * held * weight * kStep), Vec3::Zero()};
    HostChange change;
    test::Listener listener([&](double h) { body.handOff(end, h, mean); },
                            [&](double) { change = body.restore(); });
    const HostWorld attached(rig.world, listener);
    rig.step(kStep);
    EXPECT_NEAR(change.impulse_W.z(), 0.5 * weight * kStep, byWidth(1e-12, 1e-7));
    EXPECT_TRUE(change.moved);
    EXPECT_NEAR(change.offset_W.z(), -end.p_W.z(), byWidth(1e-12, 1e-7));
    EXPECT_NEAR(body.state().p_W.z(), end.p_W.z(), byWidth(1e-15, 1e-8));
    body.place({});
    EXPECT_EQ(body.state().p_W, Vec3::Zero());
  }
  rig.world.removeConstraint(&pin);
}

// A body of the island hits one of Bullet's, off centre and with friction. restore() gives back the
// momentum that the native body gains.
TEST(HandOff, ReturnsTheMomentumExchangedWithANativeNeighbour) {
  constexpr double kStep = 1.0 / 240.0;
  BulletRig rig;
  btCollisionShape& ball = rig.makeShape<btSphereShape>(btScalar(0.02));
  btRigidBody& ours = rig.addBody(ball, 0.2, Vec3::Zero());
  btRigidBody& native = rig.addBody(ball, 0.3, Vec3(0.06, 0.015, 0.005));
  ours.setFriction(1);
  native.setFriction(1);
  HapticBody body(rig.world, ours);

  RigidState island = body.state();
  island.v_W = Vec3(0.5, 0, 0);
  island.w_W = Vec3(0, 3, -2);
  const Vec3 moments = body.inertia();
  RigidState start = island;
  HostChange given;
  Vec3 total_given = Vec3::Zero();
  const auto momentum = [&] {
    return Vec3(0.2 * island.v_W + 0.3 * fromBullet(native.getLinearVelocity()));
  };
  const auto spin = [&] {
    return Vec3(moments.x() * island.w_W +
                fromBullet(native.getLocalInertia()).x() * fromBullet(native.getAngularVelocity()));
  };
  test::Listener listener(
      [&](double h) {
        start = island;
        island.p_W += h * island.v_W;
        body.handOff(island, h);
      },
      [&](double) {
        given = body.restore();
        island.v_W += given.impulse_W / 0.2;
        island.w_W += given.angular_impulse_W / moments.x();  // a ball
      });
  const HostWorld attached(rig.world, listener);

  for (int i = 0; i < 60; ++i) {
    const Vec3 p_native = fromBullet(native.getCenterOfMassPosition());
    const Vec3 momentum_before = momentum();
    const Vec3 spin_before = spin();
    rig.step(kStep);
    total_given += given.impulse_W;
    EXPECT_LT((momentum() - momentum_before).norm(), byWidth(1e-15, 1e-7)) << "step " << i;
    // Angular momentum about the origin, with the arms at which the solver acted. The contact's two
    // points are up to v dt apart along the normal, and friction acts over that distance.
    const Vec3 arms = (start.p_W - p_native).cross(given.impulse_W);
    EXPECT_LT((spin() - spin_before + arms).norm(),
              0.5 * kStep * given.impulse_W.norm() + byWidth(1e-15, 1e-8))
        << "step " << i;
  }
  EXPECT_GT(total_given.norm(), 0.01);  // they collided
}

}  // namespace
}  // namespace tandem
