// Changes that the host makes to bodies while the island holds them, and the states it gets back.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::byWidth;
using test::kGravity;
using test::NeighbourScene;

constexpr double kEdge = 2.0 * NeighbourScene::kHalf;  // [m]
constexpr double kStep = 1.0 / 60.0;                   // [s]

/// A cube and a box that is held, 5 mm apart, in free space or on a floor.
struct HeldNeighbour : NeighbourScene {
  explicit HeldNeighbour(bool on_floor = false, double linear_damping = 0.0,
                         double angular_damping = 0.0)
      : NeighbourScene(on_floor) {
    const double z = on_floor ? kHalf : 0.0;
    if (on_floor) addFloor();
    box = &addBox(Vec3(kEdge + 5e-3, 0.0, z));
    box->setDamping(static_cast<btScalar>(linear_damping), static_cast<btScalar>(angular_damping));
    start(Vec3(0.0, 0.0, z));
    run(0.1);
    EXPECT_EQ(site->neighbourCount(), 1);
  }
  btRigidBody* box;
};

TEST(HeldNeighbour, TakesTheHostsForce) {
  for (const bool on_floor : {false, true}) {
    HeldNeighbour scene(on_floor);
    for (int i = 0; i < 6; ++i) {
      scene.box->applyCentralForce(btVector3(0, 4, 0));
      scene.rig.step(kStep);
    }
    scene.run(3 * kStep);
    // mu m g = 0.3 0.2 9.81 = 0.589 N against it.
    const double felt = on_floor ? 4.0 * 0.1 - 0.5886 * (0.1 + 3 * kStep) : 4.0 * 0.1;
    EXPECT_NEAR(scene.velocityOf(*scene.box).y(), felt / 0.2,
                on_floor ? byWidth(2e-3, 4e-3) : byWidth(1e-9, 1e-5));
  }
}

TEST(HeldNeighbour, TakesTheHostsImpulse) {
  HeldNeighbour scene;
  scene.box->applyCentralImpulse(btVector3(0, btScalar(0.02), 0));
  scene.run(0.2);
  EXPECT_NEAR(scene.velocityOf(*scene.box).y(), 0.1, byWidth(1e-12, 1e-6));
}

// The box leaves the chain with the momentum of the step in which it was hit.
TEST(HeldNeighbour, TakesTheHostsImpulseAlong) {
  HeldNeighbour scene;
  scene.box->applyCentralImpulse(btVector3(0, btScalar(2), 0));
  scene.run(0.2);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_NEAR(scene.velocityOf(*scene.box).y(), 10.0, byWidth(1e-12, 1e-5));
}

TEST(HeldNeighbour, IsTeleported) {
  HeldNeighbour scene;
  scene.box->setWorldTransform(toBullet(Vec3(0.0, kEdge + 8e-3, 0.0), Quat::Identity()));
  scene.rig.step(kStep);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  EXPECT_LT((scene.positionOf(*scene.box) - Vec3(0.0, kEdge + 8e-3, 0.0)).norm(),
            byWidth(1e-12, 1e-7));
  scene.box->setWorldTransform(toBullet(Vec3(0.0, 3.0, 0.0), Quat::Identity()));
  scene.run(2 * kStep);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_LT((scene.positionOf(*scene.box) - Vec3(0.0, 3.0, 0.0)).norm(), byWidth(1e-12, 1e-6));
}

// d v / d t = -b v with 1 - 0.4 = exp(-b): damping is the same on the island as in Bullet.
TEST(HeldNeighbour, IsDampedAsTheHostHasIt) {
  HeldNeighbour scene(false, 0.4, 0.2);
  scene.box->setLinearVelocity(btVector3(0, btScalar(0.01), 0));
  scene.box->setAngularVelocity(btVector3(0, btScalar(0.1), 0));
  scene.run(0.5);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  EXPECT_NEAR(scene.velocityOf(*scene.box).y(), 0.01 * std::sqrt(0.6), byWidth(1e-10, 1e-5));
  EXPECT_NEAR(scene.box->getAngularVelocity().y(), 0.1 * std::sqrt(0.8), byWidth(1e-9, 5e-5));
  // The host changes the damping.
  scene.box->setDamping(btScalar(0.9), btScalar(0.2));
  scene.rig.step(kStep);
  const double speed = scene.velocityOf(*scene.box).y();
  scene.run(0.2);
  EXPECT_NEAR(scene.velocityOf(*scene.box).y(), speed * std::pow(0.1, 0.2), byWidth(1e-9, 1e-7));
  scene.site.reset();
  EXPECT_EQ(scene.box->getLinearDamping(), btScalar(0.9));
  EXPECT_EQ(scene.box->getAngularDamping(), btScalar(0.2));
}

TEST(HeldNeighbour, IsHeavierWhenTheHostSaysSo) {
  HeldNeighbour scene;
  btVector3 inertia;
  scene.box->getCollisionShape()->calculateLocalInertia(btScalar(0.8), inertia);
  scene.box->setMassProps(btScalar(0.8), inertia);
  scene.box->updateInertiaTensor();
  scene.run(kStep);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  scene.cube->setLinearVelocity(btVector3(btScalar(0.45), 0, 0));
  scene.run(0.1);
  EXPECT_NEAR(scene.velocityOf(*scene.box).x(), 0.05, 1e-4);
  scene.site.reset();
  EXPECT_NEAR(static_cast<double>(scene.box->getInvMass()), 1.25, 1e-6);
}

TEST(HeldNeighbour, SlipsWhenTheHostOilsIt) {
  HeldNeighbour scene(true);
  scene.box->setFriction(0);
  scene.run(kStep);
  scene.box->setLinearVelocity(btVector3(0, btScalar(0.05), 0));
  scene.run(0.3);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  EXPECT_NEAR(scene.velocityOf(*scene.box).y(), 0.05, byWidth(1e-9, 5e-5));
}

TEST(HeldNeighbour, StaysAtAJointThatItGets) {
  HeldNeighbour scene;
  btPoint2PointConstraint joint(*scene.box, btVector3(0, 0, 0));
  scene.rig.world.addConstraint(&joint);
  scene.run(kStep);
  EXPECT_EQ(scene.site->neighbourCount(), 1);
  const Vec3 pinned_W = scene.positionOf(*scene.box);
  scene.cube->setLinearVelocity(btVector3(btScalar(0.45), 0, 0));
  scene.run(0.3);
  EXPECT_LT((scene.positionOf(*scene.box) - pinned_W).norm(), byWidth(1e-9, 1e-7));
  scene.rig.world.removeConstraint(&joint);
}

TEST(HeldNeighbour, MayBeTakenOutOfTheWorldAndDeleted) {
  HeldNeighbour scene(true);
  scene.rig.world.removeRigidBody(scene.box);
  std::erase_if(scene.rig.bodies, [&](const auto& body) { return body.get() == scene.box; });
  scene.boxes.clear();
  scene.run(0.5);
  EXPECT_EQ(scene.site->neighbourCount(), 0);
  EXPECT_EQ(scene.site->status(), kTickOk);
  scene.cube->setLinearVelocity(btVector3(btScalar(0.3), 0, 0));
  scene.run(0.1);
  EXPECT_GT(scene.velocityOf(*scene.cube).x(), 0.0);
}

// A body leaves the world and returns an hour later or after the site's end. It stands on the floor
// as before.
TEST(HeldNeighbour, MeetsTheFloorAgainWhenItComesBack) {
  for (const bool site_ends : {false, true}) {
    HeldNeighbour scene(true);
    scene.rig.world.removeRigidBody(scene.box);
    scene.run(0.1);
    if (site_ends) scene.site.reset();
    scene.box->setWorldTransform(toBullet(Vec3(0.5, 0.0, 0.021), Quat::Identity()));
    scene.box->setLinearVelocity(btVector3(0, 0, 0));
    scene.rig.world.addRigidBody(scene.box);
    scene.run(0.5);
    EXPECT_NEAR(scene.positionOf(*scene.box).z(), 0.02, 3e-3) << site_ends;
    // The box becomes the cube's neighbour once more.
    scene.box->setWorldTransform(toBullet(Vec3(kEdge + 5e-3, 0.0, 0.02), Quat::Identity()));
    scene.run(0.5);
    EXPECT_NEAR(scene.positionOf(*scene.box).z(), 0.02, 3e-3) << site_ends;
  }
}

TEST(HeldNeighbour, FloorMayLeaveAndComeBack) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  btRigidBody& box = scene.addBox(Vec3(kEdge + 5e-3, 0.0, 0.02));
  scene.start(Vec3(0.0, 0.0, 0.02));
  scene.run(0.1);
  scene.rig.world.removeRigidBody(&floor);
  scene.run(0.1);
  // It falls from the first tick that begins without the floor.
  const double fall = std::sqrt(2.0 * (0.02 - scene.positionOf(box).z()) / kGravity);
  EXPECT_NEAR(fall, 0.0995, 0.0005 + 1e-5);
  for (btRigidBody* body : {&box, scene.cube}) {
    body->setWorldTransform(
        toBullet(Vec3(scene.positionOf(*body).x(), 0.0, 0.02), Quat::Identity()));
    body->setLinearVelocity(btVector3(0, 0, 0));
  }
  scene.rig.world.addRigidBody(&floor);
  scene.run(0.5);
  EXPECT_NEAR(scene.positionOf(box).z(), 0.02, 1e-4);
  scene.site.reset();
  scene.run(0.5);
  EXPECT_NEAR(scene.positionOf(box).z(), 0.02, 3e-3);
  EXPECT_TRUE(floor.checkCollideWith(&box));
  EXPECT_TRUE(box.checkCollideWith(&floor));
}

TEST(HeldNeighbour, IsGivenBackAsItWas) {
  NeighbourScene scene(true);
  btRigidBody& floor = scene.addFloor();
  btRigidBody& box = scene.addBox(Vec3(kEdge + 5e-3, 0.0, 0.02), 0.3);
  box.setDamping(btScalar(0.1), btScalar(0.3));
  box.setGravity(btVector3(0, 0, -5));
  const btScalar inverse_mass = box.getInvMass();
  const btVector3 inertia = box.getInvInertiaDiagLocal();
  const int flags = box.getFlags(), activation = box.getActivationState();
  scene.start(Vec3(0.0, 0.0, 0.02));
  scene.run(0.2);
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  EXPECT_FALSE(floor.checkCollideWith(&box));
  const btTransform pose = box.getWorldTransform();
  scene.site.reset();
  EXPECT_EQ(box.getInvMass(), inverse_mass);
  EXPECT_EQ(box.getInvInertiaDiagLocal(), inertia);
  EXPECT_EQ(box.getLinearDamping(), btScalar(0.1));
  EXPECT_EQ(box.getAngularDamping(), btScalar(0.3));
  EXPECT_EQ(box.getGravity(), btVector3(0, 0, -5));
  EXPECT_EQ(box.getFlags(), flags);
  EXPECT_EQ(box.getActivationState(), activation);
  EXPECT_EQ(box.getWorldTransform(), pose);
  for (const btRigidBody* other : {&floor, scene.cube}) {
    EXPECT_TRUE(other->checkCollideWith(&box));
    EXPECT_TRUE(box.checkCollideWith(other));
  }
}

/// A pile that sleeps in Bullet, and the cube asleep beside it, 3 mm away.
struct SleepingPile : NeighbourScene {
  static constexpr int kCount = 6;

  SleepingPile() : NeighbourScene(true) {
    addFloor();
    for (int i = 0; i < kCount; ++i) addBox(Vec3(kEdge + 3e-3 + i * kEdge, 0.0, kHalf));
    for (btRigidBody* box : boxes) box->setSleepingThresholds(btScalar(0.8), btScalar(1));
    addCube(Vec3(0.0, 0.0, kHalf));
    run(3.0);
    EXPECT_EQ(countAsleep(), kCount);
    start();
  }
  [[nodiscard]] int countAsleep() const {
    return static_cast<int>(std::count_if(boxes.begin(), boxes.end(), [](const btRigidBody* box) {
      return box->getActivationState() == ISLAND_SLEEPING;
    }));
  }
  void pushCube(double speed) {
    cube->activate(true);
    cube->setLinearVelocity(btVector3(static_cast<btScalar>(speed), 0, 0));
  }
};

// Sharing the cube wakes the bodies that touch it in Bullet. Undisturbed, all sleep again.
TEST(SleepingNeighbour, SleepsWhileItIsHeld) {
  SleepingPile pile;
  pile.run(3.0);
  EXPECT_EQ(pile.site->neighbourCount(), SleepingPile::kCount);
  EXPECT_EQ(pile.countAsleep(), SleepingPile::kCount);
  pile.run(1.0);
  EXPECT_EQ(pile.countAsleep(), SleepingPile::kCount);
  pile.site.reset();
  pile.run(3.0);
  EXPECT_EQ(pile.countAsleep(), SleepingPile::kCount);
}

TEST(SleepingNeighbour, WakesWhenItIsPushed) {
  SleepingPile pile;
  const double before = pile.positionOf(*pile.boxes[0]).x();
  pile.pushCube(1.0);
  pile.run(0.2);
  EXPECT_LT(pile.countAsleep(), SleepingPile::kCount);
  EXPECT_GT(pile.positionOf(*pile.boxes[0]).x(), before + 1e-4);
  // The pile comes to rest, and Bullet puts it to sleep again.
  pile.run(4.0);
  EXPECT_EQ(pile.countAsleep(), SleepingPile::kCount);
}

// In a call with several sub-steps Bullet applies weight once, to the bodies awake at its start.
TEST(SleepingNeighbour, HasItsWeightWhenItWakesBetweenSubSteps) {
  SleepingPile pile;
  pile.pushCube(1.0);
  for (int i = 0; i < 30; ++i) {
    pile.rig.world.stepSimulation(btScalar(4.0 / 60.0), 4, btScalar(1.0 / 60.0));
    for (const btRigidBody* box : pile.boxes)
      EXPECT_NEAR(pile.positionOf(*box).z(), NeighbourScene::kHalf, 1e-3);
  }
}

TEST(SleepingNeighbour, HostWakesItByAnImpulse) {
  SleepingPile pile;
  pile.run(0.5);
  btRigidBody& last = *pile.boxes.back();
  last.activate(true);
  last.applyCentralImpulse(btVector3(btScalar(0.1), 0, 0));
  pile.run(kStep);
  EXPECT_GT(pile.velocityOf(last).x(), 0.4);
}

// The body is slow for a long time but always pushed, so Bullet must not let it sleep.
TEST(SleepingNeighbour, DoesNotFallAsleepWhileItCreeps) {
  NeighbourScene scene;
  btRigidBody& box = scene.addBox(Vec3(kEdge + 5e-3, 0.0, 0.0));
  box.setSleepingThresholds(btScalar(0.8), btScalar(1));
  scene.start();
  scene.cube->setLinearVelocity(btVector3(btScalar(0.01), 0, 0));
  box.setLinearVelocity(btVector3(btScalar(0.01), 0, 0));
  scene.run(5.0);
  EXPECT_NEAR(scene.velocityOf(box).x(), 0.01, byWidth(1e-12, 1e-8));
  EXPECT_NEAR(scene.positionOf(box).x(), kEdge + 5e-3 + 0.05, 1e-6);
}

}  // namespace
}  // namespace tandem
