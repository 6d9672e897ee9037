#include "scene/world_look.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionDispatch/btGhostObject.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "bullet_values.h"
#include "world_rig.h"

namespace tandem::test {
namespace {

using view::DrawList;
using view::Solid;
using view::WorldLook;

double widthOf(const Solid& solid) {
  double width = 0.0;
  for (const auto& vertex : solid.mesh->vertices) {
    width = std::max(width, 2.0 * static_cast<double>(vertex.p[0]));
  }
  return width;
}

bool isEqual(const view::Colour& a, const view::Colour& b) {
  return a.red == b.red && a.green == b.green && a.blue == b.blue;
}

std::vector<std::string> namesOf(const DrawList& list) {
  std::vector<std::string> names;
  for (const Solid& solid : list.solids) names.push_back(solid.name);
  return names;
}

class WorldLookTest : public ::testing::Test {
 protected:
  btBoxShape floor_shape{vec(1, 1, 0.1)};  // half sizes [m]
  btBoxShape cube_shape{vec(0.02, 0.02, 0.02)};
  WorldRig rig;
  WorldLook look;
};

TEST_F(WorldLookTest, APlaneShowsItsNet) {
  btStaticPlaneShape plane(vec(0, 0, 1), 0);
  rig.add(plane, 0, vec(0, 0, 0));
  const DrawList list = WorldLook().look(rig.world);
  const auto nets = std::count_if(list.solids.begin(), list.solids.end(),
                                  [](const Solid& solid) { return solid.has_grid; });
  EXPECT_EQ(nets, 1);
}

TEST_F(WorldLookTest, EachBodyIsASolidAtItsPose) {
  rig.add(floor_shape, 0, vec(0, 0, -0.1));
  btRigidBody& cube = rig.add(cube_shape, 1, {0, 0, 0});
  const btQuaternion turn(btVector3(0, 0, 1), btScalar(0.3));
  cube.setWorldTransform(btTransform(turn, btVector3(1, 2, 3)));

  const DrawList list = look.look(rig.world);
  ASSERT_EQ(list.solids.size(), 2U);
  const Solid& solid = list.solids[1];
  EXPECT_LT((solid.p_WB - Vec3(1, 2, 3)).norm(), 1e-6);
  EXPECT_LT(solid.q_WB.angularDistance(Quat(Eigen::AngleAxisd(0.3, Vec3::UnitZ()))), 1e-6);
  EXPECT_NEAR(widthOf(solid), 0.04, 1e-6);
  EXPECT_FALSE(solid.is_ghost);
  EXPECT_TRUE(list.lines.empty());
}

TEST_F(WorldLookTest, KindsHaveTheirNamesAndColours) {
  rig.add(floor_shape, 0, {0, 0, -1});
  rig.add(cube_shape, 0, {0, 0, 1}).setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  rig.add(cube_shape, 1, {0, 0, 2});
  rig.add(cube_shape, 1, {0, 0, 3});

  const DrawList list = look.look(rig.world);
  EXPECT_EQ(namesOf(list),
            (std::vector<std::string>{"static 0", "kinematic 1", "dynamic 2", "dynamic 3"}));
  for (std::size_t i = 1; i < list.solids.size(); ++i) {
    EXPECT_FALSE(isEqual(list.solids[i].colour, list.solids[i - 1].colour)) << i;
  }
}

TEST_F(WorldLookTest, TheCallersTableNamesAndPaints) {
  const btRigidBody& cube = rig.add(cube_shape, 1, {0, 0, 0});
  rig.add(cube_shape, 1, {0, 0, 1});
  look.setBodyLooks({{&cube, {"peg", {0.1F, 0.2F, 0.3F}}}});
  const DrawList list = look.look(rig.world);
  EXPECT_EQ(namesOf(list), (std::vector<std::string>{"peg", "dynamic 1"}));
  EXPECT_TRUE(isEqual(list.solids[0].colour, {0.1F, 0.2F, 0.3F}));
}

TEST_F(WorldLookTest, WhatHasNoContactResponseIsAGhost) {
  btGhostObject ghost;
  ghost.setCollisionShape(&cube_shape);
  ghost.setCollisionFlags(ghost.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  rig.world.addCollisionObject(&ghost);
  const DrawList list = look.look(rig.world);
  rig.world.removeCollisionObject(&ghost);
  ASSERT_EQ(list.solids.size(), 1U);
  EXPECT_TRUE(list.solids[0].is_ghost);
  EXPECT_EQ(list.solids[0].name, "ghost 0");
}

TEST_F(WorldLookTest, BodiesThatShareAShapeShareItsMesh) {
  rig.add(cube_shape, 1, {0, 0, 0});
  rig.add(cube_shape, 1, {0, 0, 1});
  const DrawList first = look.look(rig.world), second = look.look(rig.world);
  EXPECT_EQ(first.solids[0].mesh, first.solids[1].mesh);
  EXPECT_EQ(first.solids[0].mesh, second.solids[0].mesh);
  EXPECT_EQ(look.meshCount(), 1U);
}

TEST_F(WorldLookTest, AReplacedShapeIsSeen) {
  btRigidBody& body = rig.add(cube_shape, 1, {0, 0, 0});
  const DrawList before = look.look(rig.world);
  body.setCollisionShape(&floor_shape);
  EXPECT_NEAR(widthOf(look.look(rig.world).solids[0]), 2.0, 1e-6);
  EXPECT_EQ(look.meshCount(), 1U);
  EXPECT_NEAR(widthOf(before.solids[0]), 0.04, 1e-6);  // the older list keeps its mesh
}

TEST_F(WorldLookTest, AScaledShapeIsSeen) {
  rig.add(cube_shape, 1, {0, 0, 0});
  EXPECT_NEAR(widthOf(look.look(rig.world).solids[0]), 0.04, 1e-6);
  cube_shape.setLocalScaling(btVector3(3, 1, 1));
  EXPECT_NEAR(widthOf(look.look(rig.world).solids[0]), 0.12, 1e-6);
  EXPECT_EQ(look.meshCount(), 1U);
}

TEST_F(WorldLookTest, AnotherShapeAtTheAddressOfAFreedOneIsSeen) {
  alignas(btBoxShape) std::byte memory[sizeof(btBoxShape)];
  auto* shape = new (memory) btBoxShape(vec(0.1, 0.1, 0.1));
  btRigidBody& body = rig.add(*shape, 1, {0, 0, 0});
  EXPECT_NEAR(widthOf(look.look(rig.world).solids[0]), 0.2, 1e-6);

  rig.remove(body);
  shape->~btBoxShape();
  shape = new (memory) btBoxShape(vec(0.2, 0.1, 0.1));
  btRigidBody& other = rig.add(*shape, 1, {0, 0, 0});
  EXPECT_NEAR(widthOf(look.look(rig.world).solids[0]), 0.4, 1e-6);
  rig.remove(other);
  shape->~btBoxShape();
}

TEST_F(WorldLookTest, ARemovedBodyIsGoneAndTheOthersKeepNameAndColour) {
  btRigidBody& first = rig.add(floor_shape, 1, {0, 0, 0});
  for (int i = 1; i < 4; ++i) rig.add(cube_shape, 1, {0, 0, static_cast<btScalar>(i)});
  const DrawList before = look.look(rig.world);
  rig.remove(first);  // Bullet moves the last body to its place
  const DrawList after = look.look(rig.world);
  EXPECT_EQ(namesOf(after), (std::vector<std::string>{"dynamic 3", "dynamic 1", "dynamic 2"}));
  EXPECT_TRUE(isEqual(after.solids[0].colour, before.solids[3].colour));
  EXPECT_EQ(look.meshCount(), 1U);
}

TEST_F(WorldLookTest, ABodyWithoutASurfaceOrAFinitePoseIsLeftOut) {
  btEmptyShape empty;
  rig.add(empty, 1, {0, 0, 0});
  btRigidBody& lost = rig.add(cube_shape, 1, {0, 0, 0});
  lost.getWorldTransform().setOrigin(btVector3(std::nan(""), 0, 0));
  EXPECT_TRUE(look.look(rig.world).solids.empty());
  lost.getWorldTransform().setIdentity();
}

TEST_F(WorldLookTest, TheLinksOfAMultiBodyAreSolids) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  btMultiBody body(0, 1, btVector3(1, 1, 1), false, false);
  body.setBasePos(btVector3(1, 2, 3));
  body.finalizeMultiDof();
  btMultiBodyLinkCollider collider(&body, -1);
  collider.setCollisionShape(&cube_shape);
  body.setBaseCollider(&collider);
  world.addCollisionObject(&collider);
  world.addMultiBody(&body);
  world.stepSimulation(btScalar(0.001), 0);

  const DrawList list = look.look(world, {.joints = true, .contacts = true, .bounds = true});
  ASSERT_EQ(list.solids.size(), 1U);
  EXPECT_LT((list.solids[0].p_WB - Vec3(1, 2, 3)).norm(), 1e-3);
  EXPECT_EQ(list.solids[0].name, "dynamic 0");
  EXPECT_EQ(list.lines.size(), 12U);
  world.removeMultiBody(&body);
  world.removeCollisionObject(&collider);
}

TEST_F(WorldLookTest, HeightsChangedInPlaceAreSeenOnceMeshesAreForgotten) {
  std::vector<float> heights(4, 0.0F);
  btHeightfieldTerrainShape field(2, 2, heights.data(), btScalar(-1), btScalar(1), 2, false);
  rig.add(field, 0, {0, 0, 0});
  const auto heightOf = [&] { return look.look(rig.world).solids[0].mesh->vertices[0].p[2]; };
  EXPECT_EQ(heightOf(), 0.0F);
  heights.assign(4, 0.5F);
  look.forgetMeshes();
  EXPECT_EQ(heightOf(), 0.5F);
}

}  // namespace
}  // namespace tandem::test
