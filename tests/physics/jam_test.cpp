// A kinematic body goes on, and what it pushes cannot give way: no force solves that. The body must
// neither fly nor spin.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::kGravity;
using test::NeighbourScene;

constexpr double kRadius = 0.0276;  // of the ball [m]
constexpr double kPace = 0.6;       // of the ram [m/s]

/// A shared ball of 67 g on a floor, and a ram that comes along x. Its axis is at some height above
/// the ball's centre.
struct JamScene {
  test::BulletRig rig{Vec3(0.0, 0.0, -kGravity)};
  test::FakeDevice device{Vec3(0.0, 0.0, 10.0)};
  btRigidBody *ball = nullptr, *ram = nullptr;
  double height, fastest = 0.0, fastest_spin = 0.0;

  JamScene(double lift, double friction) : height(kRadius + lift) {
    const auto rub = [&](btRigidBody& body) -> btRigidBody& {
      body.setFriction(static_cast<btScalar>(friction));
      return body;
    };
    rub(rig.addBody(rig.makeShape<btBoxShape>(toBullet(Vec3(2.0, 2.0, 0.1))), 0.0,
                    Vec3(0.0, 0.0, -0.1)));
    ball = &rub(rig.addBody(rig.makeShape<btSphereShape>(static_cast<btScalar>(kRadius)), 0.067,
                            Vec3(0.0, 0.0, kRadius)));
    const auto size = static_cast<btScalar>(0.0272);
    ram = &rub(rig.addBody(rig.makeShape<btCapsuleShape>(size, size), 0.0, placeOfRam(0.0)));
    rig.world.removeRigidBody(ram);
    ram->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    ram->setActivationState(DISABLE_DEACTIVATION);
    rig.world.addRigidBody(ram);
  }

  void addWall() {
    rig.addBody(rig.makeShape<btBoxShape>(toBullet(Vec3(0.05, 0.2, 0.2))), 0.0,
                Vec3(kRadius + 0.05, 0.0, 0.0));
  }

  void run(double rate) {
    SiteSettings settings;
    settings.peers = 1;
    settings.contact = {1000.0, 5.0};
    settings.host_step = 1.0 / rate;
    Site site(settings, rig.world, device);
    site.share(*ball);
    for (int i = 1; i <= 0.15 * rate; ++i) {
      ram->setWorldTransform(toBullet(placeOfRam(i / rate), Quat::Identity()));
      rig.step(1.0 / rate);
      fastest = std::max(fastest, fromBullet(ball->getLinearVelocity()).norm());
      fastest_spin = std::max(fastest_spin, fromBullet(ball->getAngularVelocity()).norm());
    }
  }

 private:
  [[nodiscard]] Vec3 placeOfRam(double time) const { return {kPace * time - 0.07, 0.0, height}; }
};

class Jam : public ::testing::TestWithParam<double> {};

// It was thrown at 226 m/s.
TEST_P(Jam, AgainstAWallThrowsNothing) {
  for (const double lift : {0.0, 0.0045, 0.02})
    for (const double friction : {0.3, 1.0}) {
      JamScene scene(lift, friction);
      scene.addWall();
      scene.run(GetParam());
      EXPECT_LT(scene.fastest, 1.01 * kPace) << lift << " m, " << friction;
      EXPECT_LT(scene.fastest_spin, 2.0 * kPace / kRadius) << lift << " m, " << friction;
    }
}

// The ball may only go up and down, and the floor and the ram hold it. It spun at 1e7 rad/s. Once
// the ram is 6 degrees off the locked axis, it squeezes the ball out at ten times its pace.
TEST_P(Jam, AcrossALockedAxisSpinsNothing) {
  for (const double lift : {0.002, 0.01, 0.03})
    for (const double friction : {0.3, 1.0}) {
      JamScene scene(lift, friction);
      scene.ball->setLinearFactor(btVector3(0, 0, 1));
      scene.run(GetParam());
      EXPECT_LT(scene.fastest, 10.0 * kPace) << lift << " m, " << friction;
      EXPECT_LT(scene.fastest_spin, 40.0 * kPace / kRadius) << lift << " m, " << friction;
    }
}

INSTANTIATE_TEST_SUITE_P(HostRates, Jam, ::testing::Values(60.0, 240.0, 1000.0));

}  // namespace
}  // namespace tandem
