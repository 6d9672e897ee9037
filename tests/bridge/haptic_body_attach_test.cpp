#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <string>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/bodies/haptic_body.h"
#include "bullet_bridge/src/bodies/mass_restore.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::BulletRig;

/// All settings that attaching may touch, compared bit for bit.
std::vector<btScalar> snapshot(btRigidBody& body) {
  std::vector<btScalar> numbers = {
      body.getInvMass(),          body.getLinearDamping(),
      body.getAngularDamping(),   static_cast<btScalar>(body.getActivationState()),
      body.getDeactivationTime(), static_cast<btScalar>(body.getFlags())};
  const auto add = [&](const btVector3& v) {
    numbers.insert(numbers.end(), {v.x(), v.y(), v.z()});
  };
  const auto addMatrix = [&](const btMatrix3x3& m) {
    for (int row = 0; row < 3; ++row) add(m[row]);
  };
  add(body.getInvInertiaDiagLocal());
  addMatrix(body.getInvInertiaTensorWorld());
  add(body.getGravity());
  add(body.getLinearFactor());
  add(body.getAngularFactor());
  add(body.getLinearVelocity());
  add(body.getAngularVelocity());
  add(body.getTotalForce());
  add(body.getTotalTorque());
  add(body.getCenterOfMassPosition());
  addMatrix(body.getWorldTransform().getBasis());
  add(body.getInterpolationLinearVelocity());
  add(body.getInterpolationWorldTransform().getOrigin());
  // The weight has no getter, so it is read as the force that gravity adds.
  body.applyGravity();
  add(body.getTotalForce());
  body.clearForces();
  return numbers;
}

std::string refusalOf(BulletRig& rig, btRigidBody& body, double share = 1.0) {
  try {
    const HapticBody attached(rig.world, body, share);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool mentions(const HapticBody& body, const std::string& word) {
  for (const std::string& line : body.warnings()) {
    if (line.find(word) != std::string::npos) return true;
  }
  return false;
}

TEST(HapticBodyAttach, RestoresEverythingBitForBit) {
  constexpr std::uint64_t kSeed = 7;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  const auto uniform = [&] { return random.uniform(0.0, 1.0); };
  BulletRig rig(Vec3(0.1, -9.81, 0.3));
  btCollisionShape& shape = rig.makeShape<btBoxShape>(btVector3(1, 2, 3));
  for (int i = 0; i < 500; ++i) {
    btRigidBody& body =
        rig.addBody(shape, 0.01 + uniform(), Vec3(0, 1, 0), test::turn(uniform(), {1, 2, 3}));
    body.setDamping(static_cast<btScalar>(uniform()), static_cast<btScalar>(uniform()));
    body.setLinearVelocity(btVector3(1, static_cast<btScalar>(uniform()), 0));
    // Bullet computes a weight in two ways; the host may have used either one last.
    if (i % 2 == 0)
      body.setMassProps(static_cast<btScalar>(0.01 + uniform()), body.getLocalInertia());
    body.updateInertiaTensor();
    const auto before = snapshot(body);
    { const HapticBody attached(rig.world, body, 1.0 / (1 + i % 4)); }
    EXPECT_EQ(before, snapshot(body)) << "body " << i;
    rig.world.removeRigidBody(&body);
    rig.bodies.clear();
  }
}

// It got damping and the last bit of the weight of the first. Found by "bench guest", seed
// 20261129, case 3602.
TEST(HapticBodyAttach, AnotherBodyAtTheAddressGetsNothingBack) {
  BulletRig rig(Vec3(0, -9.81, 0));
  btCollisionShape& shape = rig.makeShape<btBoxShape>(btVector3(1, 2, 3));
  alignas(16) std::byte memory[sizeof(btRigidBody)];
  const auto make = [&](btScalar mass, btScalar damping) {
    auto* body = new (memory) btRigidBody(mass, nullptr, &shape, btVector3(1, 2, 3));
    body->setDamping(damping, damping);
    rig.world.addRigidBody(body);
    return body;
  };
  btRigidBody* body = make(1, btScalar(0.1));
  {
    const HapticBody attached(rig.world, *body, 0.5);
    rig.world.removeRigidBody(body);
    body->~btRigidBody();
    body = make(3, btScalar(0.3));
    ASSERT_TRUE(attached.isInWorld());
  }
  EXPECT_EQ(body->getInvMass(), btScalar(1) / btScalar(3));
  EXPECT_EQ(body->getLinearDamping(), btScalar(0.3));
  EXPECT_EQ(body->getAngularDamping(), btScalar(0.3));
  rig.world.removeRigidBody(body);
  body->~btRigidBody();
}

// Its place in the world is what it was. Found by "bench guest" with float, seed 9201, case 163.
TEST(HapticBodyAttach, ABodyThatWasAwayHasTheWeightThatBulletGaveIt) {
  test::Random random(8);
  BulletRig rig(Vec3(0.1, -9.81, 0.3));
  for (int i = 0; i < 100; ++i) {
    btRigidBody& body = rig.addCube(1.0);
    body.setMassProps(static_cast<btScalar>(random.uniform(0.01, 1.0)), body.getLocalInertia());
    const auto comeBack = [&] { rig.world.addRigidBody(&body); };
    {
      const HapticBody attached(rig.world, body);
      rig.world.removeRigidBody(&body);
      EXPECT_FALSE(attached.isInWorld());
      comeBack();
    }
    const btVector3 weight = measureWeight(body);
    rig.world.removeRigidBody(&body);
    comeBack();
    EXPECT_EQ(weight, measureWeight(body)) << "body " << i;
    rig.world.removeRigidBody(&body);
    rig.bodies.clear();
  }
}

TEST(HapticBodyAttach, LeavesNoTraceInTheHostsSimulation) {
  const auto simulate = [](bool attach) {
    BulletRig rig(Vec3(0, -9.81, 0));
    btRigidBody& floor =
        rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0);
    btRigidBody& cube = rig.addCube(0.3, 0.02, Vec3(0, 0.1, 0), test::turn(0.3, {1, 0, 1}));
    floor.setFriction(1);
    if (attach) const HapticBody attached(rig.world, cube, 0.5);
    for (int i = 0; i < 200; ++i) rig.step(1.0 / 240.0);
    return cube.getWorldTransform();
  };
  const btTransform with = simulate(true);
  const btTransform without = simulate(false);
  EXPECT_EQ(with.getOrigin(), without.getOrigin());
  EXPECT_EQ(with.getBasis(), without.getBasis());
}

TEST(HapticBodyAttach, ScalesMassInertiaAndWeightByItsShare) {
  BulletRig rig(Vec3(0, -9.81, 0));
  btRigidBody& cube = rig.addCube(0.2);
  const Vec3 whole = fromBullet(cube.getLocalInertia());
  const HapticBody body(rig.world, cube, 0.5);
  const double relative = test::byWidth(1e-15, 1e-6);
  EXPECT_NEAR(body.mass(), 0.1, 0.1 * relative);
  EXPECT_NEAR(body.inertia().x(), 0.5 * whole.x(), whole.x() * relative);
  EXPECT_NEAR(body.gravityForce().y(), -0.981, relative);
  EXPECT_NEAR(static_cast<double>(cube.getMass()), 0.1, 0.1 * relative);
}

TEST(HapticBodyAttach, WeightLeavesOutAxesThatTheHostLocked) {
  BulletRig rig(Vec3(1, -9.81, 2));
  btRigidBody& cube = rig.addCube(1.0);
  cube.setLinearFactor(btVector3(1, 0, 1));
  const HapticBody body(rig.world, cube);
  EXPECT_EQ(body.gravityForce(), Vec3(1, 0, 2));
}

TEST(HapticBodyAttach, KeepsAGravityThatTheHostSetsWhileAttached) {
  BulletRig rig(Vec3(0, -9.81, 0));
  btRigidBody& cube = rig.addCube(0.5);
  {
    const HapticBody body(rig.world, cube, 0.5);
    rig.world.setGravity(btVector3(0, 0, -2));
    EXPECT_EQ(body.gravityForce(), Vec3(0, 0, -0.5));
  }
  cube.applyGravity();
  EXPECT_EQ(fromBullet(cube.getTotalForce()), Vec3(0, 0, -1));
}

TEST(HapticBodyAttach, RefusesWhatItCannotMoveAndSaysWhy) {
  BulletRig rig;
  btRigidBody& fixed = rig.addCube(0.0);
  EXPECT_NE(refusalOf(rig, fixed).find("static"), std::string::npos);
  btRigidBody& kinematic = rig.addCube(1.0);
  kinematic.setCollisionFlags(kinematic.getCollisionFlags() |
                              btCollisionObject::CF_KINEMATIC_OBJECT);
  EXPECT_NE(refusalOf(rig, kinematic).find("kinematic"), std::string::npos);
  btRigidBody& cube = rig.addCube(1.0);
  EXPECT_NE(refusalOf(rig, cube, 0.0).find("mass share 0"), std::string::npos);
  EXPECT_NE(refusalOf(rig, cube, 1.5).find("1.5"), std::string::npos);
  EXPECT_EQ(refusalOf(rig, cube), "");
  rig.world.removeRigidBody(&cube);
  EXPECT_NE(refusalOf(rig, cube).find("not in this Bullet world"), std::string::npos);
  BulletRig other;
  EXPECT_NE(refusalOf(other, fixed).find("not in this Bullet world"), std::string::npos);
}

TEST(HapticBodyAttach, NeverSleepsWhileHandedOffAndMaySleepAfterwards) {
  BulletRig rig(Vec3(0, -9.81, 0));
  rig.addBody(rig.makeShape<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)), 0);
  // The cube is large enough that Bullet does not rock it at 60 Hz.
  btRigidBody& cube = rig.addCube(0.3, 0.2, Vec3(0, 0.2, 0));
  {
    HapticBody attached(rig.world, cube);
    for (int i = 0; i < 5 * 60; ++i) {
      attached.handOff(attached.state(), 1.0 / 60.0);
      rig.step(1.0 / 60.0);
      ASSERT_TRUE(cube.isActive()) << "step " << i;
      (void)attached.restore();
    }
  }
  for (int i = 0; i < 5 * 60; ++i) rig.step(1.0 / 60.0);
  EXPECT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
}

TEST(HapticBodyAttach, LeavesAMovedSleeperAwakeAndAnUnmovedOneAsleep) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  cube.forceActivationState(ISLAND_SLEEPING);
  { const HapticBody attached(rig.world, cube); }
  EXPECT_EQ(cube.getActivationState(), ISLAND_SLEEPING);
  {
    HapticBody attached(rig.world, cube);
    attached.setState({Vec3(0, 1, 0), Quat::Identity(), Vec3::Zero(), Vec3::Zero()});
  }
  EXPECT_EQ(cube.getActivationState(), ACTIVE_TAG);
}

TEST(HapticBodyAttach, LeavesTheHostsActivationState) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  for (const int state : {DISABLE_DEACTIVATION, DISABLE_SIMULATION}) {
    for (const bool sleeps : {false, true}) {
      cube.forceActivationState(ACTIVE_TAG);
      {
        HapticBody attached(rig.world, cube);
        attached.handOff(attached.state(), 1e-3);
        rig.step(1e-3);
        (void)attached.restore();
        if (sleeps) attached.park();
        cube.setActivationState(state);
      }
      EXPECT_EQ(cube.getActivationState(), state) << "sleeps: " << sleeps;
    }
  }
  // A body that never sleeps in Bullet may be parked, and activate() does not change what it is.
  cube.forceActivationState(DISABLE_DEACTIVATION);
  HapticBody attached(rig.world, cube);
  attached.park();
  EXPECT_FALSE(cube.isActive());
  cube.activate();
  attached.unpark();
  EXPECT_EQ(cube.getActivationState(), DISABLE_DEACTIVATION);
}

// Parked, it looks asleep to activate(), which then made it an ordinary body for good.
TEST(HapticBodyAttach, EndsWithABodyThatNeverSleepsAfterItsHostWokeIt) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  cube.forceActivationState(DISABLE_DEACTIVATION);
  {
    HapticBody attached(rig.world, cube);
    attached.park();
    cube.activate(true);
  }
  EXPECT_EQ(cube.getActivationState(), DISABLE_DEACTIVATION);
}

TEST(HapticBodyAttach, WarnsOfBuiltInDampingAndSwitchesItOff) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  cube.setDamping(btScalar(0.25), btScalar(0.5));
  const HapticBody body(rig.world, cube);
  EXPECT_TRUE(mentions(body, "linear 0.25, angular 0.5"));
  EXPECT_EQ(cube.getLinearDamping(), 0);
  EXPECT_EQ(cube.getAngularDamping(), 0);
}

TEST(HapticBodyAttach, WarnsOfAdditionalDampingAndKeepsItsVelocity) {
  BulletRig rig;
  btCollisionShape& shape = rig.makeShape<btSphereShape>(btScalar(0.02));
  btRigidBody::btRigidBodyConstructionInfo info(btScalar(0.1), nullptr, &shape, btVector3(1, 1, 1));
  info.m_additionalDamping = true;
  rig.bodies.push_back(std::make_unique<btRigidBody>(info));
  btRigidBody& body = *rig.bodies.back();
  rig.world.addRigidBody(&body);
  body.setLinearVelocity(btVector3(1, 2, 3));
  const HapticBody attached(rig.world, body);
  EXPECT_TRUE(mentions(attached, "additional damping"));
  EXPECT_EQ(body.getLinearVelocity(), btVector3(1, 2, 3));
}

TEST(HapticBodyAttach, WarnsOfAMarginThatIsLargeForTheBody) {
  BulletRig rig;
  auto& hull = rig.makeShape<btConvexHullShape>();
  for (int corner = 0; corner < 8; ++corner) {
    const auto side = [&](int bit) { return btScalar(corner & bit ? 0.02 : -0.02); };
    hull.addPoint(btVector3(side(1), side(2), side(4)));
  }
  btRigidBody& large = rig.addBody(hull, 0.1);
  EXPECT_TRUE(mentions(HapticBody(rig.world, large), "margin 0.04 m"));
  hull.setMargin(btScalar(0.001));
  EXPECT_TRUE(HapticBody(rig.world, large).warnings().empty());
  auto& compound = rig.makeShape<btCompoundShape>();
  compound.addChildShape(btTransform::getIdentity(), &hull);
  hull.setMargin(btScalar(0.01));
  btRigidBody& inside = rig.addBody(compound, 0.1);
  EXPECT_TRUE(mentions(HapticBody(rig.world, inside), "margin 0.01 m"));
}

TEST(HapticBodyAttach, WarnsOfSpheresSmallerThanTheirMargin) {
  BulletRig rig;
  const btVector3 centres[] = {btVector3(0, 0, 0), btVector3(btScalar(0.02), 0, 0)};
  const btScalar radii[] = {btScalar(0.02), btScalar(0.01)};
  auto& spheres = rig.makeShape<btMultiSphereShape>(centres, radii, 2);
  EXPECT_TRUE(mentions(HapticBody(rig.world, rig.addBody(spheres, 0.1)),
                       "margin 0.04 m is larger than the smallest sphere, 0.01 m"));
  auto& compound = rig.makeShape<btCompoundShape>();
  compound.addChildShape(btTransform::getIdentity(), &spheres);
  EXPECT_TRUE(mentions(HapticBody(rig.world, rig.addBody(compound, 0.1)), "smallest sphere"));
  spheres.setMargin(btScalar(0.01));
  EXPECT_FALSE(mentions(HapticBody(rig.world, rig.addBody(spheres, 0.1)), "smallest sphere"));
}

TEST(HapticBodyAttach, WarnsOfNativeContactStiffnessOnly) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  EXPECT_TRUE(HapticBody(rig.world, cube).warnings().empty());
  cube.setContactStiffnessAndDamping(2000, 10);
  EXPECT_TRUE(mentions(HapticBody(rig.world, cube), "2000 N/m"));
}

TEST(HapticBodyAttach, NoticesThatTheBodyLeftTheWorldAndWritesNothingMore) {
  BulletRig rig;
  btRigidBody& first = rig.addCube(0.3);
  btRigidBody& cube = rig.addCube(0.3);
  HapticBody attached(rig.world, cube);
  EXPECT_TRUE(attached.isInWorld());
  rig.world.removeRigidBody(&first);  // moves the other body in Bullet's list
  EXPECT_TRUE(attached.isInWorld());
  rig.world.addRigidBody(&first);
  rig.world.removeRigidBody(&cube);
  EXPECT_FALSE(attached.isInWorld());

  const auto before = snapshot(cube);
  attached.setState({Vec3(1, 1, 1), Quat::Identity(), Vec3(1, 0, 0), Vec3::Zero()});
  attached.handOff({Vec3(1, 1, 1), Quat::Identity(), Vec3(1, 0, 0), Vec3::Zero()}, 0.01);
  attached.applyWrench(Vec3(1, 0, 0), Vec3(1, 0, 0), 0.01);
  EXPECT_EQ(attached.restore().impulse_W, Vec3::Zero());
  EXPECT_EQ(before, snapshot(cube));

  rig.world.addRigidBody(&cube);
  EXPECT_TRUE(attached.isInWorld());
}

/// A vector of Bullet may have any fourth number.
TEST(HapticBodyAttach, OnlyThreeNumbersOfAVectorCount) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  btVector3 factor(1, 1, 1);
  factor.setW(std::numeric_limits<btScalar>::quiet_NaN());
  cube.setLinearFactor(factor);
  const HapticBody attached(rig.world, cube, 0.5);
  EXPECT_TRUE(attached.isAsHeld());
}

TEST(HapticBodyAttach, OutlivesABodyThatTheHostDeleted) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.3);
  HapticBody attached(rig.world, cube, 0.5);
  rig.world.removeRigidBody(&cube);
  rig.bodies.clear();  // the sanitizer detects any later access
  EXPECT_FALSE(attached.isInWorld());
  EXPECT_FALSE(attached.takeHostChanges(0.01).moved);
}

}  // namespace
}  // namespace tandem
