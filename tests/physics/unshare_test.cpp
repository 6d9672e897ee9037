// Objects that the host stops sharing and shares again, or another body instead, while all runs.

#include <string>

#include <gtest/gtest.h>

#include "physics/two_hosts.h"

namespace tandem {
namespace {

using test::NeighbourScene;
using test::TwoHosts;

/// The message with which `call` is refused; empty if it is not.
template <typename Call>
std::string reason(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

void put(btRigidBody& body, const Vec3& p_W) {
  const btTransform pose = toBullet(p_W, Quat::Identity());
  body.setWorldTransform(pose);
  body.setInterpolationWorldTransform(pose);
}

/// A shared cube and a second one beside it, on a floor.
struct TwoCubes : NeighbourScene {
  btRigidBody* second = nullptr;

  TwoCubes() : NeighbourScene(true) {
    addFloor();
    addCube(Vec3(0.0, 0.0, kHalf));
    second = &rig.addCube(2.0 * kCubeMass, kHalf, Vec3(0.0, 0.2, kHalf));
    start();
    site->share(*second);
    run(0.2);
  }
};

TEST(Unshare, TheBodyIsBulletsAgain) {
  TwoCubes scene;
  scene.cube->setLinearVelocity(btVector3(0, 0, 1));
  scene.run(1.0 / 60.0);
  const double speed = NeighbourScene::velocityOf(*scene.cube).z();
  scene.site->unshare(0);
  EXPECT_EQ(scene.cube->getInvMass(), btScalar(1) / btScalar(2.0 * NeighbourScene::kCubeMass));
  EXPECT_NEAR(NeighbourScene::velocityOf(*scene.cube).z(), speed, 1e-6);
  EXPECT_FALSE(scene.site->isShared(0));
  EXPECT_FALSE(scene.site->isHeld(0));
  scene.run(1.0);
  EXPECT_EQ(scene.site->status(), kTickOk);
  EXPECT_TRUE(scene.site->isHeld(1));
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-3);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.second).z(), NeighbourScene::kHalf, 1e-4);
  scene.site->unshare(0);  // again: nothing happens
  EXPECT_FALSE(scene.site->isShared(0));
}

TEST(Unshare, TheRestStillFallsAsleep) {
  TwoCubes scene;
  scene.site->unshare(0);
  scene.run(4.0);
  const std::uint64_t skipped = scene.site->counters().host_steps_skipped;
  scene.run(1.0);
  EXPECT_GT(scene.site->counters().host_steps_skipped, skipped + 50);
}

TEST(Unshare, TheBodyMayBeTakenOutAtOnce) {
  TwoCubes scene;
  scene.site->unshare(0);
  scene.rig.world.removeRigidBody(scene.cube);
  scene.run(1.0);
  EXPECT_EQ(scene.site->status(), kTickOk);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.second).z(), NeighbourScene::kHalf, 1e-4);
}

TEST(Unshare, ItBecomesANeighbourAndIsSharedAgain) {
  TwoCubes scene;
  scene.site->unshare(0);
  put(*scene.cube, Vec3(0.0, 0.2, 3.0 * NeighbourScene::kHalf));  // onto the other
  scene.run(0.5);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  scene.site->share(0, *scene.cube);
  EXPECT_TRUE(scene.site->isShared(0));
  scene.run(0.5);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_NEAR(1.0 / scene.cube->getInvMass(), NeighbourScene::kCubeMass, 1e-6);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), 3.0 * NeighbourScene::kHalf, 1e-3);
}

TEST(Unshare, AnotherBodyTakesTheObjectsPlace) {
  TwoCubes scene;
  btRigidBody& other =
      scene.rig.addCube(1.0, NeighbourScene::kHalf, Vec3(0.5, 0.0, NeighbourScene::kHalf));
  scene.rig.world.removeRigidBody(scene.cube);
  scene.run(0.1);
  EXPECT_EQ(scene.site->status(), kBodyMissing);
  scene.site->share(0, other);
  scene.run(0.5);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_EQ(&scene.site->objectBody(0), &other);
  EXPECT_NEAR(1.0 / other.getInvMass(), 0.5, 1e-6);
  // As deep as it lay in Bullet.
  EXPECT_NEAR(NeighbourScene::positionOf(other).z(), NeighbourScene::kHalf, 1e-3);
}

TEST(Unshare, ABodyThatIsAwayGetsItsMassBackOnceItReturns) {
  for (const bool site_ends : {false, true}) {
    TwoCubes scene;
    scene.rig.world.removeRigidBody(scene.cube);
    scene.site->unshare(0);
    scene.run(0.1);
    scene.rig.world.addRigidBody(scene.cube);
    if (site_ends) {
      scene.site.reset();
    } else {
      scene.run(1.0 / 60.0);
    }
    EXPECT_EQ(scene.cube->getInvMass(), btScalar(1) / btScalar(2.0 * NeighbourScene::kCubeMass));
  }
}

// The object is named while it is missing or left to Bullet, and only then.
TEST(Unshare, WhatIsMissingIsNamed) {
  TwoCubes scene;
  EXPECT_TRUE(scene.site->warnings().empty());
  scene.rig.world.removeRigidBody(scene.second);
  scene.run(0.1);
  ASSERT_EQ(scene.site->warnings().size(), 1u);
  EXPECT_NE(scene.site->warnings()[0].find("object 1 is not in the Bullet world"),
            std::string::npos);
  scene.rig.world.addRigidBody(scene.second);
  scene.cube->setCollisionFlags(scene.cube->getCollisionFlags() |
                                btCollisionObject::CF_KINEMATIC_OBJECT);
  scene.run(0.1);
  ASSERT_EQ(scene.site->warnings().size(), 1u);
  EXPECT_NE(scene.site->warnings()[0].find("object 0 is left to Bullet"), std::string::npos);
  scene.cube->setCollisionFlags(scene.cube->getCollisionFlags() &
                                ~btCollisionObject::CF_KINEMATIC_OBJECT);
  scene.run(0.1);
  EXPECT_TRUE(scene.site->warnings().empty());
}

TEST(Unshare, PeersLetGoAndMeetAgain) {
  TwoHosts hosts;
  hosts.here.site->unshare(0);
  hosts.run(0.5);
  hosts.run(0.5, 0.5);  // nothing holds their copy now
  EXPECT_GT(hosts.x(hosts.there), 0.15);
  EXPECT_NEAR(hosts.x(hosts.here), 0.0, 1e-3);
  hosts.here.site->share(0, *hosts.here.cube);
  EXPECT_LT(hosts.run(6.0), 2.0);  // a spring between them would throw it
  EXPECT_TRUE(hosts.here.site->isHeld(0));
  EXPECT_NEAR(hosts.x(hosts.there), hosts.x(hosts.here), 0.01);
}

TEST(Unshare, WhatCannotBeIsRefused) {
  TwoCubes scene;
  Site& site = *scene.site;
  btRigidBody& fixed = scene.rig.addCube(0.0, NeighbourScene::kHalf, Vec3(1.0, 0.0, 0.0));
  EXPECT_NE(reason([&] { site.unshare(7); }).find("no object 7"), std::string::npos);
  EXPECT_NE(reason([&] { site.share(0, *scene.cube); }).find("unshare it first"),
            std::string::npos);
  site.unshare(0);
  EXPECT_NE(reason([&] { site.share(0, *scene.second); }).find("as object 1"), std::string::npos);
  EXPECT_NE(reason([&] { site.share(0, fixed); }).find("static"), std::string::npos);
  EXPECT_FALSE(site.isShared(0));
}

}  // namespace
}  // namespace tandem
