// Bodies of every class of Bullet's shapes: felt by the hand where they move as where they stand,
// shared, and lying on a floor; or refused with a clear line.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <BulletCollision/CollisionShapes/btEmptyShape.h>
#include <BulletCollision/CollisionShapes/btSdfCollisionShape.h>

#include "bridge/standing_shapes.h"
#include "physics/hand_scene.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::HandScene;
using test::Role;
using test::StandingShape;
using test::StandingShapes;

constexpr std::uint64_t kSeed = 20260304;

/// Forces of a hand that presses from drawn sides.
std::vector<Vec3> pressFromDrawnSides(const std::function<btCollisionShape&(StandingShapes&)>& make,
                                      Role role) {
  test::Random random(kSeed);
  HandScene scene(0.12 * random.direction());
  StandingShapes shapes(scene.rig);
  btCollisionShape& shape = make(shapes);
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  const Vec3 middle = 0.5 * fromBullet(low + high);
  scene.start(shape, role);
  std::vector<Vec3> forces;
  for (int i = 0; i < 8; ++i) {
    // Around the body, not through it.
    const Vec3 from = (scene.device.sample.hip.p_W - middle).normalized();
    const Vec3 side = random.direction();
    scene.press(middle + 0.15 * from);
    scene.press(middle + 0.15 * (from + side).normalized());
    scene.press(middle + 0.12 * side);
    forces.push_back(scene.press(middle + 0.01 * side));
  }
  scene.site.reset();
  return forces;
}

void expectSameForces(const std::function<btCollisionShape&(StandingShapes&)>& make,
                      const std::vector<Role>& roles) {
  const std::vector<Vec3> standing = pressFromDrawnSides(make, Role::kStanding);
  int pressed = 0;
  for (const Vec3& f_W : standing) pressed += f_W.norm() > 1.0;
  EXPECT_GT(pressed, 1);
  for (const Role role : roles) {
    const std::vector<Vec3> moving = pressFromDrawnSides(make, role);
    for (std::size_t i = 0; i < standing.size(); ++i)
      EXPECT_LT((moving[i] - standing[i]).norm(), byWidth(1e-6, 1e-2) * (1.0 + standing[i].norm()))
          << "side " << i << ", role " << static_cast<int>(role);
  }
}

class MovingConvex : public ::testing::TestWithParam<StandingShape> {};

TEST_P(MovingConvex, IsFeltAsWhereItStands) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  expectSameForces(GetParam().make, {Role::kKinematic, Role::kNeighbour, Role::kShared});
}

/// Height of a body's lowest point, with its margin [m].
double lowestOf(const btRigidBody& body) {
  const auto& shape = static_cast<const btConvexShape&>(*body.getCollisionShape());
  const btTransform& pose = body.getWorldTransform();
  const btVector3 down = pose.getBasis().transpose() * btVector3(0, 0, -1);
  return static_cast<double>((pose * shape.localGetSupportingVertex(down)).z());
}

// A shared body falls by 2 mm and lies, or rolls; it neither sinks in nor leaves. A float Bullet
// alone lets two spheres sink 3.8 mm into a large box, and a double one 1 mm.
TEST_P(MovingConvex, LiesOnAFloorWhileItIsShared) {
  for (const bool is_box : {false, true}) {
    SCOPED_TRACE(is_box);
    BulletRig rig(Vec3(0.0, 0.0, -9.81));
    StandingShapes shapes(rig);
    if (is_box)
      rig.addBody(rig.makeShape<btBoxShape>(btVector3(2, 2, btScalar(0.1))), 0.0,
                  Vec3(0.0, 0.0, -0.1));
    else
      rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0.0);
    btRigidBody& body = rig.addBody(GetParam().make(shapes), 0.2, Vec3(0.0, 0.0, 1.0));
    btTransform pose = body.getWorldTransform();
    pose.getOrigin().setZ(btScalar(1.002 - lowestOf(body)));
    body.setWorldTransform(pose);
    body.setInterpolationWorldTransform(pose);
    test::FakeDevice device(Vec3(0.0, 0.0, 5.0));
    SiteSettings settings;
    settings.peers = 1;
    Site site(settings, rig.world, device);
    site.share(body);
    for (int i = 0; i < 240; ++i) {
      rig.step(1.0 / 240.0);
      ASSERT_NEAR(lowestOf(body), 0.001, byWidth(2.5e-3, 5e-3)) << "step " << i;
    }
    EXPECT_NEAR(lowestOf(body), 0.0, byWidth(1e-3, 2e-3));
    EXPECT_TRUE(site.isHeld(0));
  }
}

INSTANTIATE_TEST_SUITE_P(Classes, MovingConvex, ::testing::ValuesIn(test::listConvexShapes()),
                         [](const auto& kind) { return kind.param.name; });

class KinematicConcave : public ::testing::TestWithParam<test::FlatTop> {};

TEST_P(KinematicConcave, IsFeltAsWhereItStands) {
  expectSameForces(GetParam().make, {Role::kKinematic});
}

INSTANTIATE_TEST_SUITE_P(Classes, KinematicConcave, ::testing::ValuesIn(test::listFlatTops()),
                         [](const auto& kind) { return kind.param.name; });

TEST(MovingShapes, ThatCannotBeSharedAreNamed) {
  BulletRig rig;
  test::FakeDevice device;
  StandingShapes shapes(rig);
  Site site(SiteSettings{}, rig.world, device);
  const auto refusal = [&](btCollisionShape& shape) -> std::string {
    try {
      btRigidBody& body = rig.addBody(rig.makeShape<btSphereShape>(btScalar(0.01)), 0.1);
      body.setCollisionShape(&shape);
      site.share(body);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  for (const auto& [shape, name] : std::vector<std::pair<btCollisionShape*, std::string>>{
           {&rig.makeShape<btEmptyShape>(), "Empty"},
           {&rig.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), "STATICPLANE"},
           {&shapes.makeGImpactMesh(), "GImpactMesh"},
           {&shapes.makeField(), "HEIGHTFIELD"},
           {&rig.makeShape<btSdfCollisionShape>(), "btSdfCollisionShape"}})
    EXPECT_NE(refusal(*shape).find("not a " + name + ";"), std::string::npos) << refusal(*shape);
}

}  // namespace
}  // namespace tandem
