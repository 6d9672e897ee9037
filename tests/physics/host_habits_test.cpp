// Hosts pin, remove, lead, switch off and rescale bodies at run time. The island leaves such a body
// to Bullet, and nothing else changes.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "physics/two_hosts.h"

namespace tandem {
namespace {

using test::kGravity;
using test::NeighbourScene;
using test::TwoHosts;

/// A shared cube on a floor, and boxes of the host beside it.
struct Habits : NeighbourScene {
  Habits() : NeighbourScene(true) {
    addFloor();
    addCube(Vec3(0.0, 0.0, kHalf));
    addBox(Vec3(0.045, 0.0, kHalf));
    addBox(Vec3(-0.045, 0.0, kHalf));
    start();
    run(0.2);
  }

  [[nodiscard]] btDiscreteDynamicsWorld& world() { return rig.world; }
  void expectBoxesStand() const {
    for (const btRigidBody* box : boxes) EXPECT_NEAR(positionOf(*box).z(), kHalf, 1e-4);
  }
  /// Pins a body as hosts do it, or frees it.
  void setMass(btRigidBody& body, double mass) {
    world().removeRigidBody(&body);
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0)
      body.getCollisionShape()->calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    body.setMassProps(static_cast<btScalar>(mass), inertia);
    body.updateInertiaTensor();
    world().addRigidBody(&body);
  }
};

TEST(HostHabits, APinnedNeighbourStands) {
  Habits scene;
  ASSERT_EQ(scene.site->neighbourCount(), 2);
  scene.setMass(*scene.boxes[0], 0.0);
  scene.run(1.0);
  EXPECT_EQ(scene.site->status(), kTickOk);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  scene.expectBoxesStand();
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-4);
}

TEST(HostHabits, APinnedSharedBodyStandsAndIsSharedAgain) {
  Habits scene;
  scene.setMass(*scene.cube, 0.0);
  scene.run(0.5);
  EXPECT_EQ(scene.site->status(), kTickOk);
  EXPECT_FALSE(scene.site->isHeld(0));
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-4);
  scene.expectBoxesStand();
  scene.setMass(*scene.cube, 2.0 * NeighbourScene::kCubeMass);
  scene.run(0.5);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_NEAR(1.0 / scene.cube->getInvMass(), NeighbourScene::kCubeMass, 1e-6);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-4);
}

TEST(HostHabits, ARemovedSharedBodyTakesOnlyItselfWithIt) {
  Habits scene;
  btRigidBody& second =
      scene.rig.addCube(0.2, NeighbourScene::kHalf, Vec3(0.0, 0.1, NeighbourScene::kHalf));
  scene.site->share(second);
  scene.run(0.2);
  scene.world().removeRigidBody(scene.cube);
  scene.run(2.0);
  EXPECT_EQ(scene.site->status(), kBodyMissing);
  EXPECT_FALSE(scene.site->isHeld(0));
  EXPECT_TRUE(scene.site->isHeld(1));
  EXPECT_NEAR(NeighbourScene::positionOf(second).z(), NeighbourScene::kHalf, 1e-4);
  scene.expectBoxesStand();
  scene.world().addRigidBody(scene.cube);
  scene.run(0.5);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_NEAR(1.0 / scene.cube->getInvMass(), NeighbourScene::kCubeMass, 1e-6);
  scene.site.reset();
  EXPECT_NEAR(1.0 / scene.cube->getInvMass(), 2.0 * NeighbourScene::kCubeMass, 1e-6);
}

TEST(HostHabits, AnotherMassOfASharedBodyIsFollowed) {
  Habits scene;
  scene.setMass(*scene.cube, 4.0);  // the copy has half of it
  scene.run(0.2);
  ASSERT_TRUE(scene.site->isHeld(0));
  const double before = NeighbourScene::velocityOf(*scene.cube).z();
  scene.cube->applyCentralForce(btVector3(0, 0, btScalar(2.0 * (kGravity + 30.0))));
  scene.run(1.0 / 60.0);
  EXPECT_NEAR(NeighbourScene::velocityOf(*scene.cube).z() - before, 30.0 / 60.0, 0.02);
}

TEST(HostHabits, AScaledSharedBodyRestsOnItsNewSurface) {
  Habits scene;
  scene.cube->getCollisionShape()->setLocalScaling(btVector3(1, 1, 3));
  scene.cube->translate(btVector3(0, 0, btScalar(2.0 * NeighbourScene::kHalf)));
  scene.run(1.0);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), 3.0 * NeighbourScene::kHalf, 1e-4);
}

TEST(HostHabits, ASharedBodyWithoutContactResponseFalls) {
  Habits scene;
  scene.cube->setCollisionFlags(scene.cube->getCollisionFlags() |
                                btCollisionObject::CF_NO_CONTACT_RESPONSE);
  scene.cube->activate(true);
  scene.run(0.5);
  EXPECT_LT(NeighbourScene::positionOf(*scene.cube).z(), -0.5);
  scene.expectBoxesStand();
}

TEST(HostHabits, AnIgnoredPairNoLongerTouchesAndTouchesAgain) {
  Habits scene;
  btCollisionObject& floor = *scene.world().getCollisionObjectArray()[0];
  ASSERT_TRUE(floor.isStaticObject());
  const auto ignore = [&](btRigidBody& body, bool is_ignored) {
    body.setIgnoreCollisionCheck(&floor, is_ignored);
    body.activate(true);
  };
  // A shared body, and a neighbour.
  ignore(*scene.cube, true);
  ignore(*scene.boxes[0], true);
  scene.run(0.1);
  EXPECT_LT(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf - 0.03);
  EXPECT_LT(NeighbourScene::positionOf(*scene.boxes[0]).z(), NeighbourScene::kHalf - 0.03);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.boxes[1]).z(), NeighbourScene::kHalf, 1e-4);
  ignore(*scene.cube, false);
  scene.cube->setLinearVelocity(btVector3(0, 0, 0));
  scene.cube->translate(btVector3(0, 0, btScalar(0.1)));
  scene.run(1.0);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-4);
  scene.site.reset();
  EXPECT_EQ(scene.cube->getNumObjectsWithoutCollision(), 0);
  EXPECT_EQ(scene.boxes[0]->getNumObjectsWithoutCollision(), 1);
  EXPECT_EQ(floor.getNumObjectsWithoutCollision(), 0);
}

/// Bullet forms new pairs by the new groups and masks, and keeps those that it has.
TEST(HostHabits, AnotherMaskOfAFloorIsFollowed) {
  Habits scene;
  btCollisionObject& floor = *scene.world().getCollisionObjectArray()[0];
  floor.getBroadphaseHandle()->m_collisionFilterMask = 0;
  scene.cube->activate(true);
  scene.run(0.2);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-3);
  scene.cube->translate(btVector3(0, 0, btScalar(0.2)));
  scene.run(0.6);
  EXPECT_LT(NeighbourScene::positionOf(*scene.cube).z(), -0.1);
}

TEST(HostHabits, ASharedBodyIsLedAndLetGo) {
  Habits scene;
  const int flags = scene.cube->getCollisionFlags();
  scene.cube->setCollisionFlags(flags | btCollisionObject::CF_KINEMATIC_OBJECT);
  scene.cube->setActivationState(DISABLE_DEACTIVATION);
  double z = NeighbourScene::kHalf;
  scene.run(0.5, 60.0, [&] {
    z += 0.01;
    scene.cube->setWorldTransform(toBullet(Vec3(0.0, 0.0, z), Quat::Identity()));
    scene.cube->setInterpolationWorldTransform(scene.cube->getWorldTransform());
  });
  EXPECT_NEAR(scene.site->object(0).p_W.z(), z - 0.01, 1e-6);  // as of the last step
  scene.cube->setCollisionFlags(flags);
  scene.cube->setLinearVelocity(btVector3(0, 0, 0));
  scene.run(2.0);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), NeighbourScene::kHalf, 1e-3);
}

TEST(HostHabits, AHandFeelsASharedBodyThatIsPinnedOrLed) {
  for (const bool is_led : {false, true}) {
    Habits scene;
    if (is_led) {
      scene.cube->setCollisionFlags(scene.cube->getCollisionFlags() |
                                    btCollisionObject::CF_KINEMATIC_OBJECT);
      scene.cube->setActivationState(DISABLE_DEACTIVATION);
    } else {
      scene.setMass(*scene.cube, 0.0);
    }
    scene.run(0.2);
    double z = 2.0 * NeighbourScene::kHalf + 0.015;
    scene.run(0.6, 60.0, [&] {
      z = std::max(z - 2e-4, 2.0 * NeighbourScene::kHalf + 0.009);
      scene.device.sample.hip.p_W = Vec3(0.0, 0.0, z);
    });
    const double depth = 2.0 * NeighbourScene::kHalf + scene.settings.hip_radius - z;
    EXPECT_NEAR(scene.device.force_W.z(), 2000.0 * depth, 0.05) << is_led;
  }
}

TEST(HostHabits, ASharedBodyThatIsSwitchedOffStays) {
  Habits scene;
  scene.cube->translate(btVector3(0, 0, 1));
  scene.run(0.1);
  const double z = NeighbourScene::positionOf(*scene.cube).z();
  scene.cube->forceActivationState(DISABLE_SIMULATION);
  scene.run(1.0);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), z, 0.05);
  EXPECT_FALSE(scene.site->isHeld(0));
}

// A site held up the sleep of its objects, so a body that its host stopped in the air fell on.
TEST(HostHabits, ASharedBodyThatItsHostPutsToSleepStopsUntilItIsWoken) {
  NeighbourScene scene(true), bare(true);
  scene.settings.peers = 1;
  scene.start(Vec3(0.0, 0.0, 5.0));
  bare.addCube(Vec3(0.0, 0.0, 5.0));
  const auto run = [&](double seconds) {
    scene.run(seconds);
    bare.run(seconds);
  };
  const auto expectAsBullet = [&](double speed) {
    EXPECT_NEAR(NeighbourScene::velocityOf(*scene.cube).z(), speed, 0.01);
    EXPECT_NEAR(NeighbourScene::velocityOf(*bare.cube).z(), speed, 0.01);
    EXPECT_EQ(scene.cube->isActive(), bare.cube->isActive());
    EXPECT_TRUE(scene.site->isHeld(0));
  };
  run(0.2);
  const double z = NeighbourScene::positionOf(*scene.cube).z();
  for (btRigidBody* cube : {scene.cube, bare.cube}) cube->setActivationState(ISLAND_SLEEPING);
  run(1.0);
  expectAsBullet(0.0);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), z, test::byWidth(1e-12, 1e-6));
  EXPECT_GT(scene.site->counters().host_steps_skipped, 0u);
  for (btRigidBody* cube : {scene.cube, bare.cube}) cube->activate();
  run(0.2);
  expectAsBullet(-0.2 * kGravity);
}

TEST(HostHabits, AHandWakesASharedBodyThatItsHostPutToSleep) {
  NeighbourScene scene(true);
  scene.settings.peers = 1;
  scene.start(Vec3(0.0, 0.0, 5.0));
  scene.run(0.1);
  scene.cube->setActivationState(ISLAND_SLEEPING);
  scene.run(0.2);
  const Vec3 p_W = NeighbourScene::positionOf(*scene.cube);
  const double reach = NeighbourScene::kHalf + scene.settings.hip_radius;
  scene.device.sample.hip.p_W = p_W + Vec3(0.001 - reach, 0.0, 0.0);
  scene.run(0.2);
  EXPECT_TRUE(scene.cube->isActive());
  EXPECT_GT(NeighbourScene::velocityOf(*scene.cube).x(), 0.0);
  EXPECT_NEAR(NeighbourScene::velocityOf(*scene.cube).z(), -0.2 * kGravity, 0.4);
}

TEST(HostHabits, ASharedBodyThatItsHostPutToSleepSleepsOnAfterTheSite) {
  NeighbourScene scene(true);
  scene.start(Vec3(0.0, 0.0, 5.0));
  scene.run(0.1);
  scene.cube->setActivationState(ISLAND_SLEEPING);
  scene.run(0.1);
  const double z = NeighbourScene::positionOf(*scene.cube).z();
  scene.site.reset();
  scene.run(0.5);
  EXPECT_EQ(scene.cube->getActivationState(), ISLAND_SLEEPING);
  EXPECT_NEAR(NeighbourScene::positionOf(*scene.cube).z(), z, 1e-6);
}

// As most hosts make one: without mass, so that both flags are set.
TEST(HostHabits, AKinematicBodyWithoutMassMayComeNear) {
  Habits scene;
  btRigidBody& lift = scene.rig.addBody(
      scene.rig.makeShape<btBoxShape>(btVector3(btScalar(0.02), btScalar(0.02), btScalar(0.02))),
      0.0, Vec3(0.0, 0.045, NeighbourScene::kHalf));
  lift.setCollisionFlags(lift.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
  scene.run(0.2);
  EXPECT_EQ(scene.site->status(), kTickOk);
  scene.expectBoxesStand();
}

TEST(HostHabits, ABodyThatMayNotTurnDoesNotTurn) {
  Habits scene;
  btRigidBody& figure =
      scene.rig.addBody(scene.rig.makeShape<btCapsuleShapeZ>(btScalar(0.02), btScalar(0.06)), 1.0,
                        Vec3(0.0, 0.06, 0.05));
  figure.setAngularFactor(btVector3(0, 0, 0));
  figure.setFriction(btScalar(0.5));
  scene.run(1.0, 60.0, [&] { figure.setLinearVelocity(btVector3(0, btScalar(-0.1), 0)); });
  EXPECT_NEAR(fromBullet(figure.getOrientation()).angularDistance(Quat::Identity()), 0.0, 1e-6);
}

TEST(HostHabits, PeersFollowAnObjectThatIsLeftToBullet) {
  TwoHosts hosts;
  NeighbourScene &here = hosts.here, &there = hosts.there;
  const int flags = here.cube->getCollisionFlags();
  here.cube->setCollisionFlags(flags | btCollisionObject::CF_KINEMATIC_OBJECT);
  hosts.put(here, 0.05);
  hosts.run(1.0);
  EXPECT_NEAR(hosts.x(there), 0.05, 0.01);
  hosts.run(0.5, 0.5);  // held by the spring
  EXPECT_NEAR(hosts.x(there), 0.05, 0.01);
  here.rig.world.removeRigidBody(here.cube);
  hosts.run(0.5, 0.5);  // nothing holds it now
  EXPECT_GT(hosts.x(there), 0.15);
  here.cube->setCollisionFlags(flags);
  here.rig.world.addRigidBody(here.cube);
  EXPECT_LT(hosts.run(4.0), 2.0);  // a spring between them would throw it at 6 m/s
  EXPECT_TRUE(here.site->isHeld(0));
  EXPECT_NEAR(hosts.x(there), hosts.x(here), 0.01);
}

TEST(HostHabits, BodiesAreBulletsWhileNobodyTicks) {
  NeighbourScene scene(true);
  scene.settings.tick_source = TickSource::kCaller;
  scene.addBox(Vec3(0.0, 0.045, 1.0));
  scene.start(Vec3(0.0, 0.0, 1.0));
  double now = 0.0;
  const auto tick = [&] {
    for (int i = 0; i < 16; ++i) scene.site->tick(now += 1e-3);
  };
  const auto hold = [&] {
    for (btRigidBody* body : {scene.cube, scene.boxes[0]}) body->setLinearVelocity({0, 0, 0});
    tick();
  };
  scene.run(0.1, 62.5, hold);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  const double z = NeighbourScene::positionOf(*scene.boxes[0]).z();
  scene.run(1.0, 62.5);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_FALSE(scene.site->isHeld(0));
  EXPECT_LT(NeighbourScene::positionOf(*scene.boxes[0]).z(), z - 2.0);
  EXPECT_LT(NeighbourScene::positionOf(*scene.cube).z(), z - 2.0);
  now += 1.0;
  scene.run(0.2, 62.5, tick);
  EXPECT_TRUE(scene.site->isHeld(0));
  EXPECT_EQ(scene.site->status(), kTickOk);
}

TEST(HostHabits, AnIslandThatDivergedGivesEverythingBackAtOnce) {
  NeighbourScene scene(true);
  scene.settings.contact = {1e300, 0.0};
  scene.addFloor();
  scene.addCube(Vec3(0.0, 0.0, NeighbourScene::kHalf));
  for (const double x : {-0.045, 0.045}) scene.addBox(Vec3(x, 0.0, NeighbourScene::kHalf));
  scene.start();
  test::FakeLink link;
  scene.site->connect(PeerId{2}, link, Vec3(0.0, 1.0, 1.0));
  scene.run(0.1);
  ASSERT_EQ(scene.site->neighbourCount(), 2);
  scene.device.sample.hip.p_W = Vec3(0.0, 0.0, 2.0 * NeighbourScene::kHalf);
  scene.run(2.0);
  ASSERT_TRUE(scene.site->status() & kStateNotFinite);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_EQ(scene.cube->getInvMass(), btScalar(1) / btScalar(2.0 * NeighbourScene::kCubeMass));
  EXPECT_NE(scene.site->proxyBody(0), nullptr);
  for (const btRigidBody* box : scene.boxes)
    EXPECT_NEAR(NeighbourScene::positionOf(*box).z(), NeighbourScene::kHalf, 1e-3);
  EXPECT_TRUE(NeighbourScene::positionOf(*scene.cube).allFinite());
}

}  // namespace
}  // namespace tandem
