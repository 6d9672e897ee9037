// Moving bodies of the host that the island holds while they are near. Contact is right, momentum
// is conserved, and no energy is created.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::byWidth;
using test::kGravity;
using test::NeighbourScene;

constexpr double kEdge = 2.0 * NeighbourScene::kHalf;  // [m]

/// Rounding of sums of momentum; with float, rounding of the velocities that the host keeps.
const double kMomentumTolerance = byWidth(1e-9, 1e-5);

TEST(Neighbours, AreTakenBeforeTouchAndGivenBackAfterwards) {
  NeighbourScene scene;
  btRigidBody& box = scene.addBox(Vec3(0.3, 0.0, 0.0));
  scene.start();
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  box.setLinearVelocity(btVector3(-1, 0, 0));
  bool held_in_time = true;
  scene.run(0.5, 60.0, [&] {
    const double gap = scene.positionOf(box).x() - scene.positionOf(*scene.cube).x() - kEdge;
    if (gap < 1e-3) held_in_time &= scene.site->neighbourCount() == 1;
  });
  EXPECT_TRUE(held_in_time);
  EXPECT_EQ(scene.site->neighbourCount(), 1);  // they stay together: restitution is 0
  scene.cube->applyCentralImpulse(btVector3(btScalar(-0.1), 0, 0));
  scene.run(0.5);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_EQ(scene.site->counters().promoted, 1u);
  EXPECT_EQ(scene.site->counters().demoted, 1u);
}

/// Adds boxes in a row beside the cube, 2 mm apart.
void addRow(NeighbourScene& scene, int count, double z = 0.0) {
  for (int i = 1; i <= count; ++i) scene.addBox(Vec3(i * (kEdge + 2e-3), 0.0, z));
}

class RowOfBoxes : public ::testing::TestWithParam<int> {};

// The host pushes the cube with 2 N for 0.1 s. Afterwards the sum of all momenta equals the
// impulse.
TEST_P(RowOfBoxes, KeepsTheMomentumOfTheHostsForce) {
  for (const double rate : {60.0, 240.0, 1000.0}) {
    NeighbourScene scene;
    addRow(scene, GetParam());
    scene.start();
    double impulse = 0.0;
    for (int i = 0; i < static_cast<int>(0.1 * rate); ++i) {
      scene.cube->applyCentralForce(btVector3(2, 0, 0));
      scene.rig.step(1.0 / rate);
      impulse += 2.0 * static_cast<double>(static_cast<btScalar>(1.0 / rate));
    }
    scene.run(0.3, rate);
    EXPECT_GT(scene.velocityOf(*scene.boxes.back()).x(), 0.1);
    const Vec3 error = scene.momentum() - Vec3(impulse, 0.0, 0.0);
    EXPECT_LT(error.norm(), kMomentumTolerance * impulse) << rate;
  }
}

// Without restitution all bodies continue together, and the rest of the energy is gone.
TEST_P(RowOfBoxes, GoesOnTogetherAfterAnImpact) {
  NeighbourScene scene;
  addRow(scene, GetParam());
  scene.start();
  scene.cube->setLinearVelocity(btVector3(btScalar(0.5), 0, 0));
  double energy = scene.energy();
  scene.run(1.0, 60.0, [&] {
    EXPECT_LE(scene.energy(), energy * (1.0 + 1e-9) + byWidth(0.0, 1e-8));
    energy = scene.energy();
  });
  const double together = 0.5 * 0.1 / (0.1 + 0.2 * GetParam());
  EXPECT_NEAR(scene.velocityOf(*scene.cube).x(), together, 2e-3 * 0.5);
  for (const btRigidBody* box : scene.boxes)
    EXPECT_NEAR(scene.velocityOf(*box).x(), together, 2e-3 * 0.5);
  EXPECT_LT((scene.momentum() - Vec3(0.05, 0.0, 0.0)).norm(), kMomentumTolerance * 0.05);
}
INSTANTIATE_TEST_SUITE_P(Lengths, RowOfBoxes, ::testing::Values(1, 3, 8));

// With weight, friction and floor but no drive, energy only falls.
TEST(Neighbours, GainNoEnergyOnAFloor) {
  for (const double speed : {0.2, 0.5, 1.0, 2.0}) {
    NeighbourScene scene(true);
    scene.addFloor();
    addRow(scene, 3, NeighbourScene::kHalf);
    scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
    scene.cube->setLinearVelocity(btVector3(static_cast<btScalar>(speed), 0, 0));
    double energy = scene.energy();
    const double start = energy;
    scene.run(1.0, 60.0, [&] {
      // Rising by 1 um adds 2 uJ of the boxes' weight.
      EXPECT_LE(scene.energy(), energy + 1e-9 * start + byWidth(1e-8, 1e-6)) << speed;
      energy = std::min(energy, scene.energy());
    });
    EXPECT_GT(scene.site->counters().promoted, 0u);
  }
}

// Hand-off alone cannot carry this press: hand, cube, box, wall.
TEST(Neighbours, CarryASustainedPressToAWall) {
  for (const double rate : {60.0, 240.0}) {
    NeighbourScene scene;
    btRigidBody& box = scene.addBox(Vec3(kEdge, 0.0, 0.0));
    scene.addWall(kEdge + NeighbourScene::kHalf);
    scene.start();
    constexpr double kSink = 24.5 / 2000.0;  // [m]
    scene.device.sample.hip.p_W = Vec3(-NeighbourScene::kHalf - 0.01 + kSink, 0.0, 0.0);
    scene.run(1.0, rate);
    EXPECT_NEAR(scene.site->force().x(), -24.5, 1e-3);
    EXPECT_NEAR(scene.positionOf(*scene.cube).x(), 0.0, 1e-6);
    EXPECT_NEAR(scene.positionOf(box).x(), kEdge, 1e-6);
    const Vec3 at_one_second = scene.positionOf(box);
    scene.run(4.0, rate);
    EXPECT_NEAR(scene.site->force().x(), -24.5, 1e-3);
    EXPECT_LT((scene.positionOf(box) - at_one_second).norm(), 1e-6);
  }
}

TEST(Neighbours, StackStandsBesideTheCube) {
  NeighbourScene scene(true);
  scene.addFloor();
  for (int i = 0; i < 4; ++i)
    scene.addBox(Vec3(kEdge + 3e-3, 0.0, NeighbourScene::kHalf + i * kEdge));
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  scene.run(2.0);
  EXPECT_EQ(scene.site->neighbourCount(), 4);
  for (int i = 0; i < 4; ++i) {
    const Vec3 at(kEdge + 3e-3, 0.0, NeighbourScene::kHalf + i * kEdge);
    EXPECT_LT((scene.positionOf(*scene.boxes[static_cast<std::size_t>(i)]) - at).norm(), 1e-5);
  }
}

// Pushed at the bottom, the stack slides with the cube or topples, and gains no energy while held.
// A box that rolls away is Bullet's, which pushes overlap out and adds some.
TEST(Neighbours, PushedStackGainsNoEnergy) {
  for (const double speed : {0.3, 1.0, 3.0}) {
    NeighbourScene scene(true);
    scene.addFloor();
    for (int i = 0; i < 4; ++i)
      scene.addBox(Vec3(kEdge + 3e-3, 0.0, NeighbourScene::kHalf + i * kEdge));
    scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
    scene.cube->setLinearVelocity(btVector3(static_cast<btScalar>(speed), 0, 0));
    double energy = scene.energy();
    const double start = energy;
    int steps_held = 0;
    scene.run(1.0, 60.0, [&] {
      if (scene.site->neighbourCount() < 4) return;
      ++steps_held;
      EXPECT_LE(scene.energy(), energy + 1e-6 * start) << speed;
      energy = std::min(energy, scene.energy());
    });
    EXPECT_GT(steps_held, 20) << speed;
  }
}

// Each touch of the hand begins within a step, and friction learns of it at the step's end. Without
// closing the slip of that step, a stack went on by 50 nm a touch.
TEST(Neighbours, StackDoesNotCreepUnderAHandThatComesAndGoes) {
  NeighbourScene scene(true);
  scene.addFloor();
  for (int i = 1; i <= 4; ++i) scene.addBox(Vec3(0.0, 0.0, NeighbourScene::kHalf + i * kEdge));
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  const double touching = -NeighbourScene::kHalf - scene.settings.proxy.radius;
  const auto moveHand = [&](double depth, double speed) {
    scene.device.sample.hip = {Vec3(touching + depth, 0.0, NeighbourScene::kHalf),
                               Vec3(speed, 0.0, 0.0)};
  };
  moveHand(-1e-3, 0.0);
  scene.run(0.5);
  std::vector<Vec3> at;
  for (const btRigidBody* box : scene.boxes) at.push_back(scene.positionOf(*box));
  constexpr double kDepth = 0.8e-3;  // 1.6 N of the 2.6 N that would move the stack
  const double w = 2.0 * M_PI;       // once a second
  double time = 0.0, deepest = 0.0;
  scene.run(20.0, 60.0, [&] {
    time += 1.0 / 60.0;
    moveHand(kDepth * std::sin(w * time), kDepth * w * std::cos(w * time));
    deepest = std::max(deepest, -scene.site->force().x());
  });
  EXPECT_GT(deepest, 1.0);
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_LT((scene.positionOf(*scene.boxes[i]) - at[i]).norm(), byWidth(1e-9, 1e-7)) << i;
}

// Bullet leaves stacks overlapping by up to 0.5 mm. Pushing this out would add energy.
TEST(Neighbours, KeepTheOverlapTheyComeWith) {
  NeighbourScene scene(true);
  scene.addFloor();
  constexpr double kOverlap = 0.3e-3;  // [m], at each face
  for (int i = 0; i < 3; ++i)
    scene.addBox(
        Vec3(kEdge + 4e-3, 0.0, NeighbourScene::kHalf - kOverlap + i * (kEdge - kOverlap)));
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  std::vector<Vec3> at;
  for (const btRigidBody* box : scene.boxes) at.push_back(scene.positionOf(*box));
  const double energy = scene.energy();
  scene.run(1.0, 60.0, [&] { EXPECT_LE(scene.energy(), energy + byWidth(1e-8, 1e-5)); });
  ASSERT_EQ(scene.site->neighbourCount(), 3);
  for (std::size_t i = 0; i < at.size(); ++i)
    EXPECT_LT((scene.positionOf(*scene.boxes[i]) - at[i]).norm(), 1e-5) << i;
}

TEST(Neighbours, TwoSharedCubesMeet) {
  NeighbourScene scene;
  btRigidBody& other = scene.rig.addCube(0.2, NeighbourScene::kHalf, Vec3(0.2, 0.0, 0.0));
  scene.start();
  scene.site->share(other);
  scene.boxes = {&other};
  other.setLinearVelocity(btVector3(btScalar(-0.5), 0, 0));
  scene.run(1.0);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_NEAR(scene.site->object(0).v_W.x(), -0.25, 1e-3);
  EXPECT_NEAR(scene.site->object(1).v_W.x(), -0.25, 1e-3);
  EXPECT_LT((scene.momentum() - Vec3(-0.05, 0.0, 0.0)).norm(), kMomentumTolerance * 0.05);
}

// A pushed box slides away on a slippery floor and hits another that the island does not know.
TEST(Neighbours, SlideAwayAndAreTheHostsAgain) {
  NeighbourScene scene;
  btRigidBody& first = scene.addBox(Vec3(kEdge + 5e-3, 0.0, 0.0));
  btRigidBody& second = scene.addBox(Vec3(0.5, 0.0, 0.0));
  scene.start();
  scene.cube->setLinearVelocity(btVector3(1, 0, 0));
  scene.run(0.2);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  scene.cube->setLinearVelocity(btVector3(0, 0, 0));
  const double momentum = 0.2 * scene.velocityOf(first).x();
  EXPECT_GT(momentum, 0.05);
  scene.run(1.5);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_GT(scene.velocityOf(second).x(), 0.1);
  EXPECT_NEAR(scene.momentum().x(), momentum, kMomentumTolerance * momentum);
}

/// The row is longer than the island has room for: the rest is Bullet's.
class ShortIsland : public ::testing::TestWithParam<int> {};

TEST_P(ShortIsland, KeepsMomentumWithTheRestOfTheRow) {
  NeighbourScene scene;
  scene.settings.max_neighbours = GetParam();
  addRow(scene, 4);
  scene.start();
  scene.cube->setLinearVelocity(btVector3(btScalar(0.5), 0, 0));
  scene.run(0.5, 60.0, [&] { EXPECT_LE(scene.site->neighbourCount(), GetParam()); });
  EXPECT_GT(scene.velocityOf(*scene.boxes.back()).x(), 0.02);
  EXPECT_LT((scene.momentum() - Vec3(0.05, 0.0, 0.0)).norm(), kMomentumTolerance * 0.05);
  // The boxes may part in any way.
  scene.run(2.0);
  EXPECT_LT((scene.momentum() - Vec3(0.05, 0.0, 0.0)).norm(), kMomentumTolerance * 0.05);
}
INSTANTIATE_TEST_SUITE_P(Capacities, ShortIsland, ::testing::Values(0, 1, 2, 3));

// The hand feels a neighbour as it feels an obstacle.
TEST(Neighbours, AreFeltByTheHand) {
  NeighbourScene scene;
  btRigidBody& box = scene.addBox(Vec3(0.0, 0.2, 0.0));
  scene.addWall(0.2);
  scene.start(Vec3(0.0, -0.2, 0.0));
  box.setLinearVelocity(btVector3(btScalar(0.1), 0, 0));
  scene.device.sample.hip.p_W = Vec3(NeighbourScene::kHalf + 0.02, 0.2, 0.0);
  double most = 0.0;
  scene.run(1.0, 60.0, [&] { most = std::max(most, scene.site->force().x()); });
  // m v^2 / 2 = K d^2 / 2 without the damper; B takes some of it.
  EXPECT_GT(most, 0.5 * 0.1 * std::sqrt(2000.0 * 0.2));
  EXPECT_LT(most, 1.5 * 0.1 * std::sqrt(2000.0 * 0.2));
  EXPECT_LT(scene.velocityOf(box).x(), 0.0);
}

}  // namespace
}  // namespace tandem
