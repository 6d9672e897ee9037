// A site gives back at its end also what the host changed meanwhile. `tandem bench guest`
// found each.

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::kGravity;
using test::NeighbourScene;

/// A shared cube on a floor.
struct Leftovers : NeighbourScene {
  btRigidBody* floor = nullptr;

  Leftovers() : NeighbourScene(true) {
    floor = &addFloor();
    addCube(Vec3(0.0, 0.0, kHalf));
    start();
    run(0.5);
  }

  /// Acceleration that the host's gravity gives the cube [m/s^2].
  [[nodiscard]] double fall() const {
    cube->clearForces();
    cube->applyGravity();
    return static_cast<double>(cube->getTotalForce().z() * cube->getInvMass());
  }
};

TEST(GuestLeftovers, AnotherInertiaLeavesTheMassAsItWas) {
  Leftovers scene;
  btRigidBody& cube = *scene.cube;
  const btVector3 inverse = btVector3(5000, 6000, 7000);
  cube.setInvInertiaDiagLocal(inverse);
  cube.updateInertiaTensor();
  scene.run(0.1);
  scene.site.reset();
  EXPECT_EQ(static_cast<double>(cube.getInvMass()),
            static_cast<double>(btScalar(1) / btScalar(2.0 * NeighbourScene::kCubeMass)));
  EXPECT_EQ(fromBullet(cube.getInvInertiaDiagLocal()), fromBullet(inverse));
}

Vec3 weightOf(btRigidBody& body) {
  body.clearForces();
  body.applyGravity();
  return fromBullet(body.getTotalForce());
}

/// Bullet rounds a weight in two ways.
TEST(GuestLeftovers, AMassSetAnewKeepsTheRoundingOfItsWeight) {
  NeighbourScene scene(true);
  scene.settings.peers = 1;
  for (int i = 1; i < 50; ++i) {
    const double mass = 0.037 * i;
    btRigidBody& bare = scene.addBox(Vec3(5.0, 0.2 * i, 0.0), mass);
    btRigidBody& shared = scene.addBox(Vec3(0.0, 0.2 * i, 0.0), mass);
    Site site(scene.settings, scene.rig.world, scene.device);
    site.share(shared);
    for (btRigidBody* body : {&bare, &shared})
      body->setMassProps(static_cast<btScalar>(mass), body->getLocalInertia() * btScalar(2));
    site.unshare(0);
    EXPECT_EQ(weightOf(shared), weightOf(bare)) << mass << " kg";
  }
}

/// addRigidBody() rounds it otherwise than setMassProps() did.
TEST(GuestLeftovers, ABodyAddedAnewHasTheWeightThatBulletGaveIt) {
  NeighbourScene scene(true);
  for (int i = 1; i < 50; ++i) {
    const double mass = 0.037 * i;
    btRigidBody& bare = scene.addBox(Vec3(5.0, 0.2 * i, 0.0), mass);
    btRigidBody& shared = scene.addBox(Vec3(0.0, 0.2 * i, 0.0), mass);
    for (btRigidBody* body : {&bare, &shared})
      body->setMassProps(static_cast<btScalar>(mass), body->getLocalInertia());
    Site site(scene.settings, scene.rig.world, scene.device);
    site.share(shared);
    scene.addBox(Vec3(9.0, 0.2 * i, 0.0));
    for (btRigidBody* body : {&bare, &shared}) {
      scene.rig.world.removeRigidBody(body);
      scene.rig.world.addRigidBody(body);
    }
    site.unshare(0);
    EXPECT_EQ(weightOf(shared), weightOf(bare)) << mass << " kg";
  }
}

TEST(GuestLeftovers, AFilterSetInPlaceKeepsTheRoundingOfTheWeight) {
  NeighbourScene scene(true);
  for (int i = 1; i < 50; ++i) {
    const double mass = 0.037 * i;
    btRigidBody& shared = scene.addBox(Vec3(0.0, 0.2 * i, 0.0), mass);
    shared.setMassProps(static_cast<btScalar>(mass), shared.getLocalInertia());
    const Vec3 weight = weightOf(shared);
    Site site(scene.settings, scene.rig.world, scene.device);
    site.share(shared);
    scene.rig.world.refreshBroadphaseProxy(&shared);
    site.unshare(0);
    EXPECT_EQ(weightOf(shared), weight) << mass << " kg";
  }
}

TEST(GuestLeftovers, ADampingOfZeroStaysZero) {
  NeighbourScene scene(true);
  scene.addFloor();
  scene.addCube(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  scene.cube->setDamping(btScalar(0.3), btScalar(0.3));
  scene.start();
  scene.run(0.1);
  scene.cube->setDamping(0, 0);
  scene.run(0.1);
  scene.site.reset();
  EXPECT_EQ(static_cast<double>(scene.cube->getLinearDamping()), 0.0);
  EXPECT_EQ(static_cast<double>(scene.cube->getAngularDamping()), 0.0);
}

TEST(GuestLeftovers, ANeighbourThatWasAwayHasItsDamping) {
  NeighbourScene scene(true);
  scene.addFloor();
  btRigidBody& box = scene.addBox(Vec3(0.05, 0.0, NeighbourScene::kHalf));
  box.setDamping(btScalar(0.25), btScalar(0.5));
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  scene.run(0.1);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  scene.rig.world.removeRigidBody(&box);
  scene.run(0.1);
  scene.rig.world.addRigidBody(&box);
  scene.run(0.1);
  scene.site.reset();
  EXPECT_EQ(static_cast<double>(box.getLinearDamping()), 0.25);
  EXPECT_EQ(static_cast<double>(box.getAngularDamping()), 0.5);
}

TEST(GuestLeftovers, AParkedBodyGetsTheGravityThatItMissed) {
  Leftovers scene;
  scene.rig.world.setGravity(btVector3(0, 0, -5));
  scene.site.reset();
  EXPECT_NEAR(scene.fall(), -5.0, test::byWidth(1e-12, 1e-5));
}

TEST(GuestLeftovers, AParkedBodyKeepsAGravityOfItsOwn) {
  Leftovers scene;
  scene.rig.world.setGravity(btVector3(0, 0, -5));
  scene.cube->setGravity(btVector3(0, 0, -3));
  scene.run(0.1);
  scene.site.reset();
  EXPECT_NEAR(scene.fall(), -3.0, test::byWidth(1e-12, 1e-5));
}

TEST(GuestLeftovers, ABodyThatComesBackPinnedKeepsItsGravity) {
  Leftovers scene;
  scene.rig.world.removeRigidBody(scene.cube);
  scene.run(0.1);
  scene.rig.world.setGravity(btVector3(0, 0, -5));
  scene.run(0.1);
  scene.cube->setMassProps(0, btVector3(0, 0, 0));
  scene.rig.world.addRigidBody(scene.cube);
  scene.site.reset();
  EXPECT_NEAR(static_cast<double>(scene.cube->getGravity().z()), -kGravity, 1e-6);
}

TEST(GuestLeftovers, AFloorThatWasAwayHoldsBodiesAgain) {
  Leftovers scene;
  scene.rig.world.removeRigidBody(scene.floor);
  scene.run(0.02);
  scene.rig.world.addRigidBody(scene.floor);
  scene.site.reset();
  EXPECT_EQ(scene.floor->getNumObjectsWithoutCollision(), 0);
  scene.run(0.5);
  EXPECT_GT(NeighbourScene::positionOf(*scene.cube).z(), 0.9 * NeighbourScene::kHalf);
}

/// All of this happens between two steps.
TEST(GuestLeftovers, AFloorThatWasAwayWhileABodyWasUnsharedIgnoresNothing) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  scene.addBox(Vec3(0.1, 0.0, NeighbourScene::kHalf));
  scene.start(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  btRigidBody& other = scene.rig.addCube(0.4, NeighbourScene::kHalf, Vec3(-0.1, 0.0, 0.02));
  scene.site->share(other);
  scene.run(0.2);
  scene.rig.world.removeRigidBody(&floor);
  scene.site->unshare(0);
  scene.rig.world.addRigidBody(&floor);
  scene.site.reset();
  EXPECT_EQ(floor.getNumObjectsWithoutCollision(), 0);
}

/// A joint's force ends where the host takes the body away from it.
TEST(GuestLeftovers, ABodyTakenOffAJointHangsOnToNothing) {
  NeighbourScene scene(true);
  scene.addCube(Vec3::Zero());
  btPoint2PointConstraint joint(*scene.cube, btVector3(0, 0, btScalar(0.1)));
  scene.rig.world.addConstraint(&joint);
  scene.start();
  scene.run(0.5);
  scene.rig.world.removeConstraint(&joint);
  scene.rig.world.setGravity(btVector3(0, 0, 0));
  btTransform pose = scene.cube->getWorldTransform();
  pose.setOrigin(btVector3(1, 0, 0));
  scene.cube->setWorldTransform(pose);
  scene.cube->setInterpolationWorldTransform(pose);
  scene.cube->setLinearVelocity(btVector3(0, 0, 0));
  scene.cube->setAngularVelocity(btVector3(0, 0, 0));
  scene.run(0.1);
  EXPECT_LT(fromBullet(scene.cube->getLinearVelocity()).norm(), 1e-6);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), 0.0, test::byWidth(1e-6, 2e-4));
}

}  // namespace
}  // namespace tandem
