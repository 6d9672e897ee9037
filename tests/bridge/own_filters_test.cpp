// Filters of native contact leave a host's objects with the site, whatever the host did to these.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"

namespace tandem {
namespace {

using test::BulletRig;

RigidState at(const Vec3& p_W) {
  RigidState state;
  state.p_W = p_W;
  return state;
}

/// A body in memory that outlives it.
struct Place {
  explicit Place(btCollisionShape& shape) { make(shape); }
  ~Place() { body().~btRigidBody(); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  [[nodiscard]] btRigidBody& body() { return *reinterpret_cast<btRigidBody*>(memory); }
  void make(btCollisionShape& shape) {
    new (memory) btRigidBody(btScalar(0.1), nullptr, &shape, btVector3(1, 1, 1));
  }
  void makeAnother(btCollisionShape& shape) {
    body().~btRigidBody();
    make(shape);
  }

  alignas(16) unsigned char memory[sizeof(btRigidBody)];
};

/// Two bodies side by side: the second one keeps the filter of the pair.
struct Pair {
  BulletRig rig;
  btCollisionShape& shape = rig.makeShape<btBoxShape>(btVector3(1, 1, 1));
  btRigidBody& first = rig.addBody(shape, 0.1);
  Place keeper{shape};
  std::unique_ptr<Obstacles> obstacles = std::make_unique<Obstacles>(rig.world);

  Pair() {
    rig.world.addRigidBody(&keeper.body());
    obstacles->addBody(0, first);
    obstacles->addBody(1, keeper.body());
    EXPECT_FALSE(keeper.body().checkCollideWith(&first));
  }
  ~Pair() { rig.world.removeRigidBody(&keeper.body()); }

  void search() { obstacles->update({at(Vec3(0, 0, 0)), at(Vec3(0, 0, 0))}, 0.04); }
};

TEST(OwnFilters, ABodyThatIsBackLosesThem) {
  Pair pair;
  pair.rig.world.removeRigidBody(&pair.keeper.body());
  pair.search();
  EXPECT_GT(pair.keeper.body().getNumObjectsWithoutCollision(), 0);
  pair.rig.world.addRigidBody(&pair.keeper.body());
  pair.search();
  EXPECT_EQ(pair.keeper.body().getNumObjectsWithoutCollision(), 0);
}

TEST(OwnFilters, AJointKeepsThePairThatItIgnores) {
  for (const bool lets_touch_before : {false, true}) {
    Pair pair;
    btRigidBody& keeper = pair.keeper.body();
    if (lets_touch_before) keeper.setIgnoreCollisionCheck(&pair.first, false);
    btPoint2PointConstraint joint(pair.first, keeper, btVector3(0, 0, 0), btVector3(0, 0, 0));
    pair.rig.world.addConstraint(&joint, true);
    pair.obstacles.reset();
    EXPECT_EQ(keeper.getNumObjectsWithoutCollision(), 1) << lets_touch_before;
    EXPECT_FALSE(keeper.checkCollideWith(&pair.first)) << lets_touch_before;
    pair.rig.world.removeConstraint(&joint);
    EXPECT_EQ(keeper.getNumObjectsWithoutCollision(), 0) << lets_touch_before;
    EXPECT_TRUE(keeper.checkCollideWith(&pair.first)) << lets_touch_before;
  }
}

TEST(OwnFilters, AnotherBodyAtTheAddressKeepsThePairThatTheHostIgnores) {
  for (const bool is_noticed_late : {false, true}) {
    Pair pair;
    pair.rig.world.removeRigidBody(&pair.keeper.body());
    if (is_noticed_late) pair.search();
    pair.keeper.makeAnother(pair.shape);
    pair.keeper.body().setIgnoreCollisionCheck(&pair.first, true);
    pair.rig.world.addRigidBody(&pair.keeper.body());
    pair.search();
    pair.obstacles.reset();
    EXPECT_EQ(pair.keeper.body().getNumObjectsWithoutCollision(), 1) << is_noticed_late;
    EXPECT_FALSE(pair.keeper.body().checkCollideWith(&pair.first)) << is_noticed_late;
  }
}

// Others come and go before the next search.
TEST(OwnFilters, AnotherBodyAtTheAddressOwesNothingToOneThatLeaves) {
  BulletRig rig;
  auto& shape = rig.makeShape<btBoxShape>(btVector3(1, 1, 1));
  btRigidBody &first = rig.addBody(shape, 0.1), &second = rig.addBody(shape, 0.1);
  Place keeper(shape);
  rig.world.addRigidBody(&keeper.body());
  {
    Obstacles obstacles(rig.world);
    obstacles.addBody(0, first);
    obstacles.addBody(2, keeper.body());
    rig.world.removeRigidBody(&keeper.body());
    keeper.makeAnother(shape);
    rig.world.addRigidBody(&keeper.body());
    obstacles.addBody(1, second);
    obstacles.removeBody(0);
    obstacles.update(std::vector<RigidState>(3, at(Vec3(0, 0, 0))), 0.04);
    EXPECT_TRUE(keeper.body().checkCollideWith(&first));
    EXPECT_FALSE(keeper.body().checkCollideWith(&second));
  }
  EXPECT_EQ(keeper.body().getNumObjectsWithoutCollision(), 0);
  rig.world.removeRigidBody(&keeper.body());
}

// A ghost that stands is made anew, and looks the same.
TEST(OwnFilters, AnotherStandingObjectAtTheAddressIsFilteredAgain) {
  BulletRig rig;
  auto& shape = rig.makeShape<btBoxShape>(btVector3(1, 1, 1));
  btRigidBody& body = rig.addBody(shape, 0.1);
  alignas(16) unsigned char memory[sizeof(btCollisionObject)];
  const auto makeWall = [&] {
    auto* wall = new (memory) btCollisionObject;
    wall->setCollisionShape(&shape);
    rig.world.addCollisionObject(wall, btBroadphaseProxy::StaticFilter);
    return wall;
  };
  btCollisionObject* wall = makeWall();
  {
    Obstacles obstacles(rig.world);
    obstacles.addBody(0, body);
    obstacles.update({at(Vec3(0, 0, 0))}, 0.04);
    EXPECT_FALSE(wall->checkCollideWith(&body));
    rig.world.removeCollisionObject(wall);
    wall->~btCollisionObject();
    wall = makeWall();
    obstacles.update({at(Vec3(0, 0, 0))}, 0.04);
    EXPECT_FALSE(wall->checkCollideWith(&body));
  }
  EXPECT_EQ(wall->getNumObjectsWithoutCollision(), 0);
  rig.world.removeCollisionObject(wall);
  wall->~btCollisionObject();
}

// A crowd of bodies that the host deletes does not make the site forget one that is back.
TEST(OwnFilters, ABodyThatIsBackLosesThemWhileManyOthersAreDeleted) {
  constexpr int kMany = 100;
  Pair pair;
  BulletRig& rig = pair.rig;
  std::vector<std::unique_ptr<btRigidBody>> crowd;
  std::vector<RigidState> states(2 + kMany, at(Vec3(0, 0, 0)));
  for (int i = 0; i < kMany; ++i) {
    crowd.push_back(std::make_unique<btRigidBody>(btScalar(0.1), nullptr, &pair.shape));
    rig.world.addRigidBody(crowd.back().get());
    pair.obstacles->addBody(2 + i, *crowd.back());
  }
  rig.world.removeRigidBody(&pair.keeper.body());
  pair.obstacles->update(states, 0.04);
  rig.world.addRigidBody(&pair.keeper.body());
  for (const auto& body : crowd) rig.world.removeRigidBody(body.get());
  crowd.clear();
  pair.obstacles->update(states, 0.04);
  pair.obstacles.reset();
  EXPECT_EQ(pair.keeper.body().getNumObjectsWithoutCollision(), 0);
  EXPECT_EQ(pair.first.getNumObjectsWithoutCollision(), 0);
}

}  // namespace
}  // namespace tandem
