#include <limits>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btEmptyShape.h>

#include "bridge/obstacle_scene.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::isNear;
using test::ObstacleScene;

RigidState at(const Vec3& p) {
  RigidState state;
  state.p_W = p;
  return state;
}

TEST(ObstacleSearch, KnowsWhatIsNearAndWhatIsNot) {
  ObstacleScene scene;
  scene.addPlane(0.5);
  scene.start(Vec3(0, 0.03, 0));
  EXPECT_TRUE(isNear(scene.obstacles, 0, scene.state, 0.011));
  EXPECT_FALSE(isNear(scene.obstacles, 0, scene.state, 0.009));
  EXPECT_FALSE(isNear(scene.obstacles, 1, scene.state, 1.0)) << "a body it was not told of";
  // A plane's bounding box is all of space, its surface is not.
  EXPECT_FALSE(isNear(scene.obstacles, 0, at(Vec3(0, 1, 0)), 0.5));
}

TEST(ObstacleSearch, FollowsTheBodyAndForgetsWhatIsFar) {
  ObstacleScene scene;
  scene.addObstacle(scene.rig.makeShape<btSphereShape>(btScalar(0.05)), 0.5, Vec3(1, 0, 0));
  scene.start(Vec3(0, 0, 0));
  const RigidState beside = at(Vec3(1, 0.08, 0));
  EXPECT_FALSE(isNear(scene.obstacles, 0, beside, 0.05));  // the search has not covered this place
  scene.obstacles.update({beside}, 0.04);
  EXPECT_TRUE(isNear(scene.obstacles, 0, beside, 0.05));
  scene.obstacles.update({at(Vec3(0, 0, 0))}, 0.04);
  EXPECT_FALSE(isNear(scene.obstacles, 0, beside, 0.05));
}

TEST(ObstacleSearch, FollowsAStaticObjectThatTheHostMoves) {
  ObstacleScene scene;
  btRigidBody& box =
      scene.addObstacle(scene.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.5, Vec3(0, -1, 0));
  scene.start(Vec3(0, 0.025, 0));
  EXPECT_TRUE(isNear(scene.obstacles, 0, scene.state, 0.006));
  box.setWorldTransform(toBullet(Vec3(0, -1.01, 0), Quat::Identity()));
  scene.search();
  EXPECT_FALSE(isNear(scene.obstacles, 0, scene.state, 0.006));
  EXPECT_TRUE(isNear(scene.obstacles, 0, scene.state, 0.016));
}

TEST(ObstacleSearch, LeavesOutWhatMovesOrGivesNoContact) {
  ObstacleScene scene;
  btCollisionShape& shape = scene.rig.makeShape<btBoxShape>(btVector3(1, 1, 1));
  scene.rig.addBody(shape, 5.0);
  btRigidBody& kinematic = scene.addObstacle(shape, 0.5);
  kinematic.setCollisionFlags(kinematic.getCollisionFlags() |
                              btCollisionObject::CF_KINEMATIC_OBJECT);
  btRigidBody& trigger = scene.addObstacle(shape, 0.5);
  trigger.setCollisionFlags(trigger.getCollisionFlags() |
                            btCollisionObject::CF_NO_CONTACT_RESPONSE);
  scene.obstacles.addSphere(0, 0.01);
  scene.start(Vec3(0, 0, 0));
  EXPECT_FALSE(isNear(scene.obstacles, 0, scene.state, 0.0));
  EXPECT_TRUE(scene.obstacles.nearSpheres().empty());
}

TEST(ObstacleSearch, HonoursTheHostsFilters) {
  ObstacleScene scene;
  btRigidBody& floor = scene.addPlane(0.5);
  btRigidBody& ignoring = scene.rig.addCube(0.1, 0.02, Vec3(0, 0.02, 0));
  ignoring.setIgnoreCollisionCheck(&floor, true);
  btRigidBody& masked = scene.rig.addCube(0.1, 0.02, Vec3(0, 0.02, 0));
  scene.rig.world.removeRigidBody(&masked);
  scene.rig.world.addRigidBody(&masked, btBroadphaseProxy::DefaultFilter,
                               btBroadphaseProxy::DefaultFilter);
  btRigidBody& plain = scene.rig.addCube(0.1, 0.02, Vec3(0, 0.02, 0));
  scene.obstacles.addBody(0, ignoring);
  scene.obstacles.addBody(1, masked);
  scene.obstacles.addBody(2, plain);
  const RigidState state = at(Vec3(0, 0.02, 0));
  scene.obstacles.update({state, state, state}, 0.04);
  EXPECT_FALSE(isNear(scene.obstacles, 0, state, 0.01));
  EXPECT_FALSE(isNear(scene.obstacles, 1, state, 0.01));
  EXPECT_TRUE(isNear(scene.obstacles, 2, state, 0.01));
}

TEST(ObstacleSearch, FiltersNativeContactWhileACandidateAndGivesItBack) {
  BulletRig rig(Vec3(0, -9.81, 0));
  btRigidBody& floor =
      rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0);
  btRigidBody& cube = rig.addCube(0.1, 0.02, Vec3(0, 0.02, 0));
  const auto isFiltered = [&] {
    return !cube.checkCollideWith(&floor) || !floor.checkCollideWith(&cube);
  };
  {
    Obstacles obstacles(rig.world);
    obstacles.addBody(0, cube);
    EXPECT_FALSE(isFiltered());
    obstacles.update({at(Vec3(0, 0.02, 0))}, 0.04);
    EXPECT_TRUE(isFiltered());
    obstacles.update({at(Vec3(0, 1, 0))}, 0.04);
    EXPECT_FALSE(isFiltered());
    obstacles.update({at(Vec3(0, 0.02, 0))}, 0.04);
    EXPECT_TRUE(isFiltered());
    obstacles.addBody(1, rig.addCube(0.1, 0.02, Vec3(0, 0.5, 0)));
    EXPECT_TRUE(isFiltered());
    obstacles.removeBody(0);
    EXPECT_FALSE(isFiltered());
    obstacles.addBody(0, cube);
    EXPECT_TRUE(isFiltered());
  }
  EXPECT_FALSE(isFiltered());
  EXPECT_EQ(cube.getNumObjectsWithoutCollision(), 0);
  EXPECT_EQ(floor.getNumObjectsWithoutCollision(), 0);
}

TEST(ObstacleSearch, SurvivesObjectsAndBodiesThatTheHostDeletes) {
  BulletRig rig;
  auto& shape = rig.makeShape<btBoxShape>(btVector3(1, 1, 1));
  auto wall = std::make_unique<btRigidBody>(btScalar(0), nullptr, &shape);
  rig.world.addRigidBody(wall.get());
  btRigidBody& kept = rig.addCube(0.1, 0.02, Vec3(0, 1.02, 0));
  auto gone = std::make_unique<btRigidBody>(btScalar(0.1), nullptr, &shape, btVector3(1, 1, 1));
  rig.world.addRigidBody(gone.get());
  Obstacles obstacles(rig.world);
  obstacles.addBody(0, kept);
  obstacles.addBody(1, *gone);
  const std::vector<RigidState> states = {at(Vec3(0, 1.02, 0)), at(Vec3(0, 2, 0))};
  obstacles.update(states, 0.04);
  EXPECT_TRUE(isNear(obstacles, 0, states[0], 0.01));
  // The sanitizer detects any access to the removed body.
  rig.world.removeRigidBody(gone.get());
  gone.reset();
  obstacles.update(states, 0.04);
  EXPECT_TRUE(isNear(obstacles, 0, states[0], 0.01));
  rig.world.removeRigidBody(wall.get());
  wall.reset();
  obstacles.update(states, 0.04);
  EXPECT_FALSE(isNear(obstacles, 0, states[0], 0.01));
  EXPECT_EQ(kept.getNumObjectsWithoutCollision(), 0);
}

/// Bullet leaves the fourth number of many bounds as it finds it.
TEST(ObstacleSearch, OnlyThreeNumbersOfABoundCount) {
  class Careless final : public btSphereShape {
   public:
    using btSphereShape::btSphereShape;
    void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override {
      btSphereShape::getAabb(pose, low, high);
      low.setW(std::numeric_limits<btScalar>::quiet_NaN());
      high.setW(++calls_);
    }

   private:
    mutable btScalar calls_ = 0;
  };
  BulletRig rig;
  btRigidBody& ball = rig.addBody(rig.makeShape<Careless>(btScalar(0.02)), 0.1);
  Obstacles obstacles(rig.world);
  obstacles.addBody(0, ball);
  obstacles.update({at(Vec3(0, 0, 0))}, 0.04);
  EXPECT_FALSE(obstacles.update({at(Vec3(0, 0, 0))}, 0.04)) << "the ball was taken anew";
}

// A host may pin a body, which then stands, and free it in place.
TEST(ObstacleSearch, HoldsABodyThatStoodBefore) {
  BulletRig rig;
  btRigidBody& floor =
      rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0);
  btRigidBody& cube = rig.addCube(0.1, 0.02, Vec3(0, 0.02, 0));
  btRigidBody& pinned = rig.addCube(0.1, 0.02, Vec3(0, 0.06, 0));
  const std::vector<RigidState> states = {at(Vec3(0, 0.02, 0)), at(Vec3(0, 0.06, 0))};
  {
    Obstacles obstacles(rig.world);
    obstacles.addBody(0, cube);
    pinned.setMassProps(0, btVector3(0, 0, 0));
    obstacles.update(states, 0.04);
    EXPECT_FALSE(pinned.checkCollideWith(&cube));
    pinned.setMassProps(btScalar(0.1), btVector3(1, 1, 1));
    obstacles.addBody(1, pinned);
    obstacles.update(states, 0.04);
    EXPECT_TRUE(isNear(obstacles, 1, states[1], 0.05)) << "the floor";
    EXPECT_FALSE(pinned.checkCollideWith(&cube));
  }
  for (const btRigidBody* body : {&floor, &cube, &pinned})
    EXPECT_EQ(body->getNumObjectsWithoutCollision(), 0);
}

TEST(ObstacleSearch, RefusesBodiesThatItCannotHold) {
  BulletRig rig;
  Obstacles obstacles(rig.world);
  btRigidBody& cube = rig.addCube(0.1);
  obstacles.addBody(0, cube);
  EXPECT_THROW(obstacles.addBody(0, rig.addCube(0.1)), Error);
  EXPECT_THROW(obstacles.addBody(1, rig.addCube(0.0)), Error);
  EXPECT_THROW(obstacles.addBody(-1, rig.addCube(0.1)), Error);
}

/// Obstacles near a ball of 1 cm at the origin.
std::vector<Obstacle> findNearBall(BulletRig& rig, double margin = 0.04) {
  Obstacles obstacles(rig.world);
  obstacles.addSphere(0, 0.01);
  obstacles.update({at(Vec3::Zero())}, margin);
  return obstacles.nearSpheres();
}

TEST(NearSpheres, GivesShapesWithTheirPoses) {
  BulletRig rig;
  const Quat turned = test::turn(0.4, {1, 1, 0});
  rig.addBody(rig.makeShape<btSphereShape>(btScalar(0.25)), 0, Vec3(0, 0.28, 0));
  rig.addBody(rig.makeShape<btBoxShape>(btVector3(btScalar(0.25), btScalar(0.5), 1)), 0,
              Vec3(0.125, 0, 0), turned);
  rig.addBody(rig.makeShape<btCapsuleShape>(btScalar(0.125), btScalar(0.5)), 0, Vec3(0, 0, 0.25),
              turned);
  rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(-0.03125)), 0);
  const auto found = findNearBall(rig);
  ASSERT_EQ(found.size(), 4u);
  const double rounding = byWidth(1e-15, 1e-7);
  EXPECT_EQ(std::get<Sphere>(found[0].shape).radius, 0.25);
  EXPECT_NEAR(found[0].p_WB.y(), 0.28, rounding);
  // Half extents include the margin, as Bullet collides them.
  EXPECT_LT((std::get<Box>(found[1].shape).half_extents - Vec3(0.25, 0.5, 1)).norm(), rounding);
  EXPECT_LT(found[1].q_WB.angularDistance(turned), byWidth(1e-7, 1e-3));
  EXPECT_EQ(std::get<Capsule>(found[2].shape).radius, 0.125);
  EXPECT_EQ(std::get<Capsule>(found[2].shape).half_length, 0.25);
  EXPECT_EQ(std::get<Plane>(found[3].shape).normal_B, Vec3(0, 0, 1));
  EXPECT_EQ(std::get<Plane>(found[3].shape).offset, -0.03125);
}

TEST(NearSpheres, KnowsCapsulesAndCylindersAlongAnyAxis) {
  BulletRig rig;
  rig.addBody(rig.makeShape<btCapsuleShapeX>(btScalar(0.125), btScalar(0.5)), 0);
  rig.addBody(rig.makeShape<btCapsuleShapeZ>(btScalar(0.125), btScalar(0.5)), 0);
  const btScalar r(0.125), h(0.25);
  rig.addBody(rig.makeShape<btCylinderShapeX>(btVector3(h, r, r)), 0);
  rig.addBody(rig.makeShape<btCylinderShape>(btVector3(r, h, r)), 0);
  rig.addBody(rig.makeShape<btCylinderShapeZ>(btVector3(r, r, h)), 0);
  const auto found = findNearBall(rig);
  ASSERT_EQ(found.size(), 5u);
  EXPECT_EQ(std::get<Capsule>(found[0].shape).axis, Axis::kX);
  EXPECT_EQ(std::get<Capsule>(found[1].shape).axis, Axis::kZ);
  EXPECT_EQ(std::get<Capsule>(found[1].shape).half_length, 0.25);
  const Axis axes[] = {Axis::kX, Axis::kY, Axis::kZ};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& cylinder = std::get<Cylinder>(found[2 + i].shape);
    EXPECT_EQ(cylinder.axis, axes[i]);
    EXPECT_NEAR(cylinder.radius, 0.125, byWidth(1e-15, 1e-7));
    EXPECT_NEAR(cylinder.half_length, 0.25, byWidth(1e-15, 1e-7));
  }
}

TEST(NearSpheres, ExpandsCompoundsAndTakesOnlyTheChildrenNearby) {
  BulletRig rig;
  auto& inner = rig.makeShape<btCompoundShape>();
  inner.addChildShape(toBullet(Vec3(0, 0.1, 0), Quat::Identity()),
                      &rig.makeShape<btSphereShape>(btScalar(0.08)));
  auto& outer = rig.makeShape<btCompoundShape>();
  outer.addChildShape(toBullet(Vec3(0.5, 0, 0), test::turn(M_PI / 2, {0, 0, 1})), &inner);
  outer.addChildShape(toBullet(Vec3(5, 0, 0), Quat::Identity()),
                      &rig.makeShape<btSphereShape>(btScalar(0.08)));
  rig.addBody(outer, 0, Vec3(-0.5, 0, 0));
  const auto found = findNearBall(rig);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_LT((found[0].p_WB - Vec3(-0.1, 0, 0)).norm(), byWidth(1e-15, 1e-7));
}

TEST(NearSpheres, LooksAsFarAsTheMarginAndSkipsShapesTheIslandDoesNotKnow) {
  BulletRig rig;
  rig.addBody(rig.makeShape<btSphereShape>(btScalar(0.25)), 0,
              Vec3(0, 0.31, 0));  // 5 cm from the ball
  rig.addBody(rig.makeShape<btEmptyShape>(), 0);
  EXPECT_TRUE(findNearBall(rig, 0.04).empty());
  EXPECT_EQ(findNearBall(rig, 0.06).size(), 1u);
}

TEST(NearSpheres, SeesAFarPlaneOnlyWhenItIsReached) {
  BulletRig rig;
  rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(-1)), 0);
  EXPECT_TRUE(findNearBall(rig, 0.5).empty());
  EXPECT_EQ(findNearBall(rig, 1.0).size(), 1u);
}

}  // namespace
}  // namespace tandem
