// Bodies whose simulation the host has disabled stand, as if they had no end of mass.

#include <algorithm>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::NeighbourScene;

constexpr double kHalf = NeighbourScene::kHalf;

/// A shared cube, and a box whose simulation is disabled.
struct Switched : NeighbourScene {
  explicit Switched(const Vec3& box_W, const Vec3& cube_W) : NeighbourScene(true) {
    addFloor();
    addBox(box_W);
    boxes[0]->forceActivationState(DISABLE_SIMULATION);
    start(cube_W);
  }
  void expectBoxStandsAt(const Vec3& place_W) const {
    EXPECT_LT((positionOf(*boxes[0]) - place_W).norm(), 1e-6);
    EXPECT_EQ(velocityOf(*boxes[0]), Vec3::Zero());
  }
};

// Bullet's solver gave it a part of each blow, and the cube went through it.
TEST(DisabledSimulation, ACubeStopsAtSuchABox) {
  const Vec3 place(0.1, 0.0, kHalf);
  Switched scene(place, Vec3(0.0, 0.0, kHalf));
  scene.run(0.1);
  scene.cube->setFriction(0);
  scene.run(2.0, 60.0, [&] {
    scene.cube->activate(true);
    scene.cube->applyCentralForce(btVector3(1, 0, 0));
  });
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).x(), 0.1 - 2.0 * kHalf, 1e-4);
  scene.expectBoxStandsAt(place);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
}

TEST(DisabledSimulation, ACubeStandsOnSuchABoxInMidAir) {
  const Vec3 place(0.0, 0.0, 1.0);
  Switched scene(place, Vec3(0.0, 0.0, 1.0 + 2.5 * kHalf));
  scene.run(2.0);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), 1.0 + 2.0 * kHalf, 1e-4);
  scene.expectBoxStandsAt(place);
}

TEST(DisabledSimulation, ANeighbourIsSwitchedOffAndOnUnderACube) {
  NeighbourScene scene(true);
  scene.addFloor();
  scene.addBox(Vec3(0.0, 0.0, kHalf));
  scene.start(Vec3(0.0, 0.0, 3.0 * kHalf));
  scene.run(0.5);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  btRigidBody& box = *scene.boxes[0];
  box.forceActivationState(DISABLE_SIMULATION);
  scene.run(1.0);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), 3.0 * kHalf, 1e-4);
  EXPECT_NEAR(NeighbourScene::positionOf(box).z(), kHalf, 1e-4);
  box.forceActivationState(ACTIVE_TAG);
  scene.run(0.1);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  box.setLinearVelocity(btVector3(0, 1, 0));
  box.setFriction(0);
  scene.run(0.1);
  EXPECT_GT(NeighbourScene::positionOf(box).y(), 0.05);
  EXPECT_EQ(scene.site->status(), kTickOk);
}

// It was body and obstacle at a time, and kept filters of both. Found by "bench guest", seed
// 777001, case 4446.
TEST(DisabledSimulation, ACubeThatIsSharedSwitchedOffLosesAllFilters) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  scene.addBox(Vec3(0.0, 0.045, kHalf));
  scene.addCube(Vec3(0.0, 0.0, kHalf));
  scene.cube->forceActivationState(DISABLE_SIMULATION);
  scene.start();
  scene.run(0.5);
  scene.site.reset();
  for (const btRigidBody* body : {scene.cube, scene.boxes[0], &floor})
    EXPECT_EQ(body->getNumObjectsWithoutCollision(), 0);
}

TEST(DisabledSimulation, AHandFeelsSuchABox) {
  Switched scene(Vec3(0.5, 0.0, 1.0), Vec3(0.0, 0.0, kHalf));
  scene.run(0.1);
  double z = 1.0 + kHalf + 0.015;
  scene.run(0.6, 60.0, [&] {
    z = std::max(z - 2e-4, 1.0 + kHalf + 0.009);
    scene.device.sample.hip.p_W = Vec3(0.5, 0.0, z);
  });
  const double depth = 1.0 + kHalf + scene.settings.hip_radius - z;
  EXPECT_NEAR(scene.device.force_W.z(), 2000.0 * depth, 0.05);
}

}  // namespace
}  // namespace tandem
