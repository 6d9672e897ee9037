// Bullet's compliant contact with our gains: static sink, gains per contact point, series, damping.

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/native/native_coupling.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;

constexpr double kMass = 0.1;                       // [kg]
constexpr double kWeight = kMass * 9.81;            // [N]
constexpr double kHalf = 0.02;                      // [m]
constexpr double kStep = 1e-3;                      // [s]
const CouplerGains kGains{2000.0, 10.0};            // [N/m, N s/m]
const double kSink = kWeight / kGains.stiffness;    // 0.4905 mm
const double kSinkTolerance = byWidth(1e-7, 2e-6);  // [m]; float: 0.1 % of a step's fall

/// Steps the host once while the hand moves. The hand moves in the pre-tick: before that,
/// stepSimulation() overwrites the velocity of kinematic bodies.
void moveInPreTick(BulletRig& rig, KinematicSphere& hand, const Vec3& end_W) {
  test::Listener listener([&](double dt) { hand.moveTo(end_W, dt); },
                          [&](double) { hand.arrive(); });
  const HostWorld host(rig.world, listener);
  rig.step(kStep);
}

/// Depth at which a body rests in a static box whose top is at z = 0.
struct Rest : ::testing::Test {
  BulletRig rig{Vec3(0, 0, -9.81)};
  btRigidBody& ground = rig.addCube(0.0, 0.5, Vec3(0, 0, -0.5));

  double sinkOf(btRigidBody& body, double height) {
    body.setActivationState(DISABLE_DEACTIVATION);
    for (int i = 0; i < 3000; ++i) rig.step(kStep);
    return height - body.getCenterOfMassPosition().z();
  }
  btRigidBody& addSphere() {
    return rig.addBody(rig.makeShape<btSphereShape>(btScalar(kHalf)), kMass, Vec3(0, 0, kHalf));
  }
};

TEST_F(Rest, SphereSinksByItsWeightOverK) {
  btRigidBody& sphere = addSphere();
  setSoftContact(sphere, kGains);
  EXPECT_NEAR(sinkOf(sphere, kHalf), kSink, kSinkTolerance);
}

TEST_F(Rest, ContactForceIsTheWeight) {
  btRigidBody& sphere = addSphere();
  setSoftContact(sphere, kGains);
  sinkOf(sphere, kHalf);
  const Vec3 f_W = computeContactImpulse(rig.world, sphere) / kStep;
  EXPECT_NEAR(f_W.z(), kWeight, byWidth(1e-6, 1e-3));
  const Vec3 reaction_W = computeContactImpulse(rig.world, ground) / kStep;
  EXPECT_EQ(reaction_W, -f_W);
}

TEST_F(Rest, BoxOnFourPointsSinksAsMuchWithItsGainsShared) {
  btRigidBody& box = rig.addCube(kMass, kHalf, Vec3(0, 0, kHalf));
  setSoftContact(box, kGains, 4);
  EXPECT_NEAR(sinkOf(box, kHalf), kSink,
              10 * kSinkTolerance);  // the four points share the load unevenly
}

TEST_F(Rest, GainsAreOfEachContactPoint) {
  btRigidBody& box = rig.addCube(kMass, kHalf, Vec3(0, 0, kHalf));
  setSoftContact(box, kGains);
  EXPECT_NEAR(sinkOf(box, kHalf), kSink / 4, 10 * kSinkTolerance);
}

TEST_F(Rest, TwoCarriersAreInSeries) {
  btRigidBody& sphere = addSphere();
  setSoftContact(sphere, kGains);
  setSoftContact(ground, kGains);
  EXPECT_NEAR(sinkOf(sphere, kHalf), 2 * kSink, 2 * kSinkTolerance);
}

// One step of a kinematic sphere into a heavy body. Implicit Euler's force is K (overlap + v dt) +
// B v, with the speed at the step's end. The body's recoil lowers that speed. Bullet's own damping
// of 0.1 N s/m would add 0.05 N.
TEST(SoftContact, PushesByOverlapAndSpeedAndNothingElse) {
  BulletRig rig;
  const double mass = 1e3;  // [kg]
  btRigidBody& wall = rig.addCube(mass, kHalf, Vec3(kHalf, 0, 0));
  const double overlap = 0.001, speed = 0.5;  // [m, m/s]
  KinematicSphere hand(rig.world, 0.01, Vec3(overlap - 0.01, 0, 0));
  setSoftContact(hand.rigid(), kGains);
  moveInPreTick(rig, hand, Vec3(overlap - 0.01 + speed * kStep, 0, 0));
  const Vec3 f_W = computeContactImpulse(rig.world, wall) / kStep;
  const double K = kGains.stiffness, B = kGains.damping;
  const double expected =
      (K * (overlap + speed * kStep) + B * speed) / (1.0 + kStep * (kStep * K + B) / mass);
  EXPECT_NEAR(f_W.x(), expected, byWidth(1e-6, 2e-3));
}

TEST(NativeDamping, IsExactForAFreeBody) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  const double b = 0.3;  // [N s/m]
  setNativeDamping(cube, b);
  cube.setLinearVelocity(btVector3(1, 0, 0));
  for (int i = 0; i < 500; ++i) rig.step(kStep);
  EXPECT_NEAR(cube.getLinearVelocity().x(), std::exp(-b / kMass * 0.5), byWidth(1e-12, 2e-5));
}

TEST(NativeGuide, LeavesOneDirectionAndGivesTheFactorsBack) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  cube.setLinearFactor(btVector3(1, 1, 0));
  {
    const NativeGuide guide(cube, -Vec3::UnitY());
    cube.applyImpulse(btVector3(1, 1, 1), toBullet(Vec3(0.01, 0, 0)));
    EXPECT_EQ(cube.getLinearVelocity().x(), 0);
    EXPECT_GT(cube.getLinearVelocity().y(), 0);
    EXPECT_EQ(cube.getLinearVelocity().z(), 0);
    EXPECT_EQ(cube.getAngularVelocity(), btVector3(0, 0, 0));
  }
  EXPECT_EQ(cube.getLinearFactor(), btVector3(1, 1, 0));
  EXPECT_EQ(cube.getAngularFactor(), btVector3(1, 1, 1));
}

TEST(NativeGuide, RefusesWhatFactorsCannotDo) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(kMass);
  EXPECT_FALSE(NativeGuide::canFollow(Vec3(0.6, 0.8, 0)));
  EXPECT_THROW(NativeGuide(cube, Vec3(0.6, 0.8, 0)), std::invalid_argument);
  EXPECT_EQ(cube.getLinearFactor(), btVector3(1, 1, 1));
}

TEST(KinematicSphere, GoesWhereItIsToldAndLeavesTheWorldAgain) {
  BulletRig rig;
  {
    KinematicSphere hand(rig.world, 0.01, Vec3(0.3, 0, 0));
    moveInPreTick(rig, hand, Vec3(0.302, 0, 0));
    EXPECT_NEAR(hand.state().p_W.x(), 0.302, byWidth(1e-15, 1e-7));
    EXPECT_NEAR(hand.state().v_W.x(), 2.0, byWidth(1e-10, 1e-3));
    EXPECT_TRUE(hand.isInWorld());
  }
  EXPECT_EQ(rig.world.getNumCollisionObjects(), 0);
}

}  // namespace
}  // namespace tandem
