#include "scene/world_lines.h"

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "bullet_values.h"
#include "scene/world_look.h"
#include "world_rig.h"

namespace tandem::test {
namespace {

using view::Line;
using view::WorldDetails;
using view::WorldLook;

/// A host's own drawer, which nobody may use or change.
class HostDrawer : public btIDebugDraw {
 public:
  void drawLine(const btVector3&, const btVector3&, const btVector3&) override { ++calls; }
  void drawContactPoint(const btVector3&, const btVector3&, btScalar, int,
                        const btVector3&) override {
    ++calls;
  }
  void reportErrorWarning(const char*) override { ++calls; }
  void draw3dText(const btVector3&, const char*) override { ++calls; }
  void setDebugMode(int) override { ++calls; }
  [[nodiscard]] int getDebugMode() const override { return DBG_DrawConstraints; }
  int calls = 0;
};

// A cube that rests on a plane and is held by a ball joint at its top.
class WorldLinesTest : public ::testing::Test {
 protected:
  WorldLinesTest() {
    rig.add(plane, 0, {0, 0, 0});
    btRigidBody& cube = rig.add(cube_shape, 1, vec(0, 0, 0.02));
    joint = std::make_unique<btPoint2PointConstraint>(cube, vec(0, 0, 0.02));
    rig.world.addConstraint(joint.get());
    rig.world.stepSimulation(btScalar(0.001), 0);
  }
  ~WorldLinesTest() override { rig.world.removeConstraint(joint.get()); }

  std::vector<Line> linesOf(const WorldDetails& details) {
    return WorldLook().look(rig.world, details).lines;
  }

  btStaticPlaneShape plane{btVector3(0, 0, 1), 0};
  btBoxShape cube_shape{vec(0.02, 0.02, 0.02)};  // half sizes [m]
  WorldRig rig;
  std::unique_ptr<btPoint2PointConstraint> joint;
};

TEST_F(WorldLinesTest, WithoutDetailsThereAreNone) { EXPECT_TRUE(linesOf({}).empty()); }

TEST_F(WorldLinesTest, AJointIsDrawnAtItsPivot) {
  const std::vector<Line> lines = linesOf({.joints = true});
  ASSERT_FALSE(lines.empty());
  for (const Line& line : lines) {
    EXPECT_LT((line.from_W - Vec3(0, 0, 0.04)).norm(), 0.1);
    EXPECT_GT((line.to_W - line.from_W).norm(), 0.0);
  }
}

TEST_F(WorldLinesTest, AContactIsALineAlongItsNormal) {
  const std::vector<Line> lines = linesOf({.contacts = true});
  ASSERT_FALSE(lines.empty());
  for (const Line& line : lines) {
    const Vec3 along = line.to_W - line.from_W;
    EXPECT_NEAR(std::abs(along.z()), 0.01, 1e-6);
    EXPECT_NEAR(line.from_W.z(), 0.0, 1e-3);
  }
}

TEST_F(WorldLinesTest, BoundsAreTwelveLinesForABoxAndNoneForAPlane) {
  EXPECT_EQ(linesOf({.bounds = true}).size(), 12U);
}

TEST_F(WorldLinesTest, LookingDoesNotChangeTheWorld) {
  WorldRig other;
  btRigidBody& watched = rig.add(cube_shape, 1, vec(0.2, 0, 0.1));
  btRigidBody& alone = other.add(cube_shape, 1, vec(0.2, 0, 0.1));
  other.add(plane, 0, {0, 0, 0});
  for (int step = 0; step < 300; ++step) {
    linesOf({.joints = true, .contacts = true, .bounds = true});
    rig.world.stepSimulation(btScalar(0.001), 0);
    other.world.stepSimulation(btScalar(0.001), 0);
  }
  EXPECT_TRUE(watched.getWorldTransform() == alone.getWorldTransform());
  EXPECT_LT(watched.getWorldTransform().getOrigin().z(), btScalar(0.03));
}

TEST_F(WorldLinesTest, TheHostsDrawerStaysInItsPlaceUnused) {
  HostDrawer drawer;
  rig.world.setDebugDrawer(&drawer);
  EXPECT_FALSE(linesOf({.joints = true, .contacts = true, .bounds = true}).empty());
  EXPECT_EQ(rig.world.getDebugDrawer(), &drawer);
  EXPECT_EQ(drawer.calls, 0);
  rig.world.setDebugDrawer(nullptr);
  EXPECT_FALSE(linesOf({.joints = true}).empty());
  EXPECT_EQ(rig.world.getDebugDrawer(), nullptr);
}

}  // namespace
}  // namespace tandem::test
