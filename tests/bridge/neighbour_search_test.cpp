// The search selects bodies to hold before they can be touched; all others stay with the host.

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/surroundings/neighbours.h"

namespace tandem {
namespace {

using test::BulletRig;

constexpr double kHalf = 0.02;         // half edge of all cubes [m]
constexpr double kHorizon = 2.5 / 60;  // [s]
/// D of a pair at rest [m]: 2 mm + 1/2 20 m/s^2 T^2.
constexpr double kAtRest = 2e-3 + 10.0 * kHorizon * kHorizon;

/// A cube of the island's at the origin.
NeighbourSeed makeSeed(const Vec3& v_W = Vec3::Zero()) {
  return {Vec3::Constant(-kHalf), Vec3::Constant(kHalf), v_W};
}

struct NeighbourSearchTest : ::testing::Test {
  BulletRig rig;

  /// A box whose face is `gap` away from the cube's at +x.
  btRigidBody& addAtGap(double gap, double mass = 0.2) {
    return rig.addCube(mass, kHalf, Vec3(2.0 * kHalf + gap, 0.0, 0.0));
  }
  std::vector<btRigidBody*> find(NeighbourSearch& search, const Vec3& v_W = Vec3::Zero()) {
    return search.find({makeSeed(v_W)}, kHorizon);
  }
  std::vector<btRigidBody*> findOnce(const Vec3& v_W = Vec3::Zero()) {
    NeighbourSearch search(rig.world, 16);
    return find(search, v_W);
  }
};

using Bodies = std::vector<btRigidBody*>;

TEST_F(NeighbourSearchTest, TakesWhoIsNearerThanItsReach) {
  btRigidBody& near = addAtGap(0.9 * kAtRest);
  rig.addCube(0.2, kHalf, Vec3(0.0, 2.0 * kHalf + 1.1 * kAtRest, 0.0));
  EXPECT_EQ(findOnce(), Bodies{&near});
}

TEST_F(NeighbourSearchTest, ReachesFartherForWhoComesFaster) {
  btRigidBody& box = addAtGap(0.1);
  EXPECT_TRUE(findOnce().empty());
  EXPECT_EQ(findOnce(Vec3(2.0, 0.0, 0.0)), Bodies{&box});
  box.setLinearVelocity(btVector3(-2, 0, 0));
  EXPECT_EQ(findOnce(), Bodies{&box});
  // Cubes side by side at equal speed do not approach each other.
  EXPECT_TRUE(findOnce(Vec3(-2.0, 0.0, 0.0)).empty());
}

TEST_F(NeighbourSearchTest, ReachesFartherForWhoTurns) {
  btRigidBody& box = addAtGap(0.05);
  EXPECT_TRUE(findOnce().empty());
  box.setAngularVelocity(btVector3(0, 0, 30));
  EXPECT_EQ(findOnce(), Bodies{&box});
}

TEST_F(NeighbourSearchTest, TakesTheWholeChain) {
  Bodies row;
  for (int i = 0; i < 8; ++i)
    row.push_back(&rig.addCube(0.2, kHalf, Vec3((i + 1) * (2.0 * kHalf + 2e-3), 0.0, 0.0)));
  EXPECT_EQ(findOnce(), row);
}

TEST_F(NeighbourSearchTest, ChainEndsWhereAGapIsTooWide) {
  btRigidBody& first = addAtGap(2e-3);
  addAtGap(2e-3 + 2.0 * kHalf + 1.1 * kAtRest);
  EXPECT_EQ(findOnce(), Bodies{&first});
}

TEST_F(NeighbourSearchTest, WhoIsHeldStaysForAWhile) {
  btRigidBody& box = addAtGap(0.9 * kAtRest);
  NeighbourSearch search(rig.world, 16);
  const auto moveTo = [&](double gap) {
    box.setWorldTransform(toBullet(Vec3(2.0 * kHalf + gap, 0.0, 0.0), Quat::Identity()));
    rig.world.updateSingleAabb(&box);
  };
  EXPECT_EQ(find(search), Bodies{&box});
  moveTo(1.4 * kAtRest);
  EXPECT_EQ(find(search), Bodies{&box});
  moveTo(1.6 * kAtRest);
  EXPECT_TRUE(find(search).empty());
  moveTo(1.4 * kAtRest);
  EXPECT_TRUE(find(search).empty());  // it was released above
  moveTo(0.9 * kAtRest);
  EXPECT_EQ(find(search), Bodies{&box});
}

TEST_F(NeighbourSearchTest, CapacityTakesTheNearestFirst) {
  btRigidBody& far = addAtGap(8e-3);
  btRigidBody& near = rig.addCube(0.2, kHalf, Vec3(0.0, 2.0 * kHalf + 4e-3, 0.0));
  btRigidBody& nearest = rig.addCube(0.2, kHalf, Vec3(0.0, 0.0, 2.0 * kHalf + 2e-3));
  NeighbourSearch one(rig.world, 1), two(rig.world, 2), many(rig.world, 16), none(rig.world, 0);
  EXPECT_TRUE(find(none).empty());
  EXPECT_EQ(find(one), Bodies{&nearest});
  EXPECT_EQ(find(two), (Bodies{&nearest, &near}));
  EXPECT_EQ(find(many), (Bodies{&nearest, &near, &far}));
}

// Bodies that touch the island's own come before those that touch a neighbour, at any distance.
TEST_F(NeighbourSearchTest, CapacityTakesWaveByWave) {
  btRigidBody& first = addAtGap(5e-3);
  addAtGap(5e-3 + 2.0 * kHalf);
  btRigidBody& other = rig.addCube(0.2, kHalf, Vec3(0.0, 2.0 * kHalf + 8e-3, 0.0));
  NeighbourSearch two(rig.world, 2);
  EXPECT_EQ(find(two), (Bodies{&first, &other}));
}

TEST_F(NeighbourSearchTest, EqualGapsComeInTheHostsOrder) {
  Bodies added;
  for (const Vec3& side : {Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 0, 0)})
    added.push_back(&rig.addCube(0.2, kHalf, (2.0 * kHalf + 2e-3) * side));
  EXPECT_EQ(findOnce(), added);
}

// The order depends neither on addresses nor on the broadphase's history.
TEST_F(NeighbourSearchTest, OrderIsTheSameForEqualWorlds) {
  const auto findIndices = [](bool with_history) {
    BulletRig world;
    constexpr unsigned kSeed = 7;
    std::mt19937_64 random(kSeed);
    const auto draw = [&] {
      return 0.1 * (static_cast<double>(random()) / static_cast<double>(random.max()) - 0.5);
    };
    for (int i = 0; i < 40; ++i) world.addCube(0.2, 5e-3, Vec3(draw(), draw(), draw()));
    if (with_history) {
      for (const auto& body : world.bodies) {
        const btTransform pose = body->getWorldTransform();
        body->setWorldTransform(toBullet(Vec3(1.0, 2.0, 3.0), Quat::Identity()));
        world.world.updateAabbs();
        body->setWorldTransform(pose);
      }
      world.world.updateAabbs();
    }
    NeighbourSearch search(world.world, 30);
    std::vector<int> indices;
    for (const btRigidBody* body : search.find({makeSeed()}, kHorizon))
      indices.push_back(body->getWorldArrayIndex());
    return indices;
  };
  const std::vector<int> indices = findIndices(false);
  EXPECT_EQ(indices.size(), 30u);
  EXPECT_EQ(indices, findIndices(true));
}

TEST_F(NeighbourSearchTest, LeavesOutWhatDoesNotMoveByForces) {
  addAtGap(2e-3, 0.0);  // static
  btRigidBody& ghost = rig.addCube(0.2, kHalf, Vec3(0.0, 2.0 * kHalf + 2e-3, 0.0));
  ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  btRigidBody& frozen = rig.addCube(0.2, kHalf, Vec3(0.0, 0.0, 2.0 * kHalf + 2e-3));
  frozen.forceActivationState(DISABLE_SIMULATION);
  EXPECT_TRUE(findOnce().empty());
}

TEST_F(NeighbourSearchTest, TakesAChainWholeOrNotAtAll) {
  btRigidBody& near = addAtGap(2e-3);
  btRigidBody& far = rig.addCube(0.2, kHalf, Vec3(5.0, 0.0, 0.0));
  const btVector3 half =
      (far.getWorldTransform().getOrigin() - near.getWorldTransform().getOrigin()) / 2;
  btPoint2PointConstraint joint(near, far, half, -half);
  rig.world.addConstraint(&joint);
  EXPECT_EQ(findOnce(), (Bodies{&near, &far}));
  // Bullet closes what is wide open.
  joint.setPivotA(half + btVector3(0, 1, 0));
  EXPECT_TRUE(findOnce().empty());
  joint.setPivotA(half);
  // There is no room for both.
  NeighbourSearch small(rig.world, 1);
  EXPECT_TRUE(find(small).empty());
  // One of them cannot be held.
  far.forceActivationState(DISABLE_SIMULATION);
  EXPECT_TRUE(findOnce().empty());
  far.forceActivationState(ACTIVE_TAG);
  // A joint that is off holds nothing.
  joint.setEnabled(false);
  EXPECT_EQ(findOnce(), Bodies{&near});
  joint.setEnabled(true);
  // The chain of a body that the island has anyway comes, too.
  NeighbourSearch search(rig.world, 16);
  search.exclude(near);
  EXPECT_EQ(find(search), Bodies{&far});
  rig.world.removeConstraint(&joint);
  EXPECT_EQ(findOnce(), Bodies{&near});
}

TEST_F(NeighbourSearchTest, LeavesOutWhatTheIslandHasAnyway) {
  btRigidBody& own = addAtGap(2e-3);
  NeighbourSearch search(rig.world, 16);
  search.exclude(own);
  EXPECT_TRUE(find(search).empty());
}

TEST_F(NeighbourSearchTest, TakesKinematicBodiesButNobodyBehindThem) {
  btRigidBody& gripper = addAtGap(2e-3, 0.0);
  gripper.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  addAtGap(2e-3 + 2.0 * kHalf + 2e-3);
  EXPECT_EQ(findOnce(), Bodies{&gripper});
}

TEST_F(NeighbourSearchTest, ForgetsWhoHasLeftTheWorld) {
  btRigidBody& box = addAtGap(2e-3);
  NeighbourSearch search(rig.world, 16);
  EXPECT_EQ(find(search), Bodies{&box});
  rig.world.removeRigidBody(&box);
  EXPECT_TRUE(find(search).empty());
  rig.world.addRigidBody(&box);
  EXPECT_EQ(find(search), Bodies{&box});
}

}  // namespace
}  // namespace tandem
