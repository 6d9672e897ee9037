// Hosts change surfaces, shapes and places of what bodies rest on, while all is quiet.

#include <cmath>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::kGravity;
using test::NeighbourScene;

constexpr double kHalf = NeighbourScene::kHalf;
constexpr double kSlope = 0.35;                        // [rad]
const double kDownhill = kGravity * std::sin(kSlope);  // [m/s^2]
/// Bodies wake with the first tick that begins after the change: at most a tick's speed is missing.
const double kTickSpeed = 1e-3 * kDownhill;  // [m/s]

/// A shared cube and a box of the host, at rest on a rough slope.
struct Slope : NeighbourScene {
  btRigidBody& floor;

  Slope()
      : NeighbourScene(true),
        floor(rig.addBody(rig.makeShape<btBoxShape>(btVector3(2, 2, btScalar(0.1))), 0.0,
                          -0.1 * up(), tilt())) {
    addCube(kHalf * up());
    addBox(kHalf * up() + Vec3(0.0, 0.045, 0.0));
    for (btRigidBody* body : {cube, boxes[0], &floor}) {
      body->setCenterOfMassTransform(toBullet(positionOf(*body), tilt()));
      body->setInterpolationWorldTransform(body->getWorldTransform());
      body->setFriction(1);
    }
    boxes[0]->setSleepingThresholds(btScalar(0.8), 1);  // Bullet's own
    start();
    run(3.0);
  }

  static Quat tilt() { return test::turn(kSlope, Vec3::UnitY()); }
  static Vec3 up() { return tilt() * Vec3::UnitZ(); }
  static double downhill(const btRigidBody& body) {
    return velocityOf(body).dot(tilt() * Vec3::UnitX());
  }
  /// True if no host step did any work in a moment.
  [[nodiscard]] bool isQuiet() {
    const auto before = site->counters().host_steps_skipped;
    run(5.0 / 60.0);
    return site->counters().host_steps_skipped == before + 5;
  }
};

TEST(SurfaceChanges, BodiesSlideWhenTheFloorUnderThemBecomesSlippery) {
  Slope scene;
  ASSERT_TRUE(scene.isQuiet());
  scene.floor.setFriction(0);
  scene.run(0.5);
  for (const btRigidBody* body : {scene.cube, scene.boxes[0]})
    EXPECT_NEAR(Slope::downhill(*body), 0.5 * kDownhill, kTickSpeed);
}

TEST(SurfaceChanges, ABodySlidesWhenItBecomesSlippery) {
  Slope scene;
  ASSERT_TRUE(scene.isQuiet());
  scene.cube->setFriction(0);
  scene.run(0.3);  // then the box is Bullet's again: the cube is too far away
  EXPECT_NEAR(Slope::downhill(*scene.cube), 0.3 * kDownhill, kTickSpeed);
  EXPECT_NEAR(Slope::downhill(*scene.boxes[0]), 0.0, 1e-6);
}

TEST(SurfaceChanges, BodiesFallWhenTheFloorUnderThemIsScaledDown) {
  Slope scene;
  ASSERT_TRUE(scene.isQuiet());
  scene.floor.getCollisionShape()->setLocalScaling(btVector3(1, 1, btScalar(0.5)));
  scene.run(0.5);
  for (const btRigidBody* body : {scene.cube, scene.boxes[0]})
    EXPECT_NEAR(NeighbourScene::positionOf(*body).dot(Slope::up()), kHalf - 0.05, 1e-4);
}

TEST(SurfaceChanges, BodiesSlideWhenTheFloorUnderThemIsTilted) {
  Slope scene;
  ASSERT_TRUE(scene.isQuiet());
  const Quat steeper = test::turn(1.0, Vec3::UnitY());
  scene.floor.setWorldTransform(toBullet(-0.1 * (steeper * Vec3::UnitZ()), steeper));
  scene.run(0.5);
  for (const btRigidBody* body : {scene.cube, scene.boxes[0]})
    EXPECT_GT(NeighbourScene::velocityOf(*body).norm(), 1.0);
}

TEST(SurfaceChanges, AWorldWithoutChangesStaysQuiet) {
  Slope scene;
  ASSERT_TRUE(scene.isQuiet());
  scene.floor.setFriction(scene.floor.getFriction());
  EXPECT_TRUE(scene.isQuiet());
}

// Friction of the step before braked it by 0.05 m/s.
TEST(SurfaceChanges, FrictionSetTogetherWithAVelocityActsAtOnce) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  scene.start(Vec3(0.0, 0.0, kHalf));
  scene.run(0.5);
  floor.setFriction(0);
  scene.cube->activate(true);
  scene.cube->setLinearVelocity(btVector3(1, 0, 0));
  scene.run(1.0 / 60.0);
  EXPECT_NEAR(NeighbourScene::velocityOf(*scene.cube).x(), 1.0, 1e-6);
}

TEST(SurfaceChanges, RestitutionSetTogetherWithAPlaceActsAtOnce) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  scene.start(Vec3(0.0, 0.0, kHalf));
  scene.run(0.5);
  scene.cube->setRestitution(1);
  floor.setRestitution(1);
  // It strikes within the step.
  scene.cube->translate(btVector3(0, 0, btScalar(0.01)));
  scene.cube->activate(true);
  scene.cube->setLinearVelocity(btVector3(0, 0, -2));
  scene.run(1.0 / 60.0);
  EXPECT_GT(NeighbourScene::velocityOf(*scene.cube).z(), 1.7);
}

}  // namespace
}  // namespace tandem
