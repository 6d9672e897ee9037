// The adaptor without a preloaded process: its work around the steps of a world.

#include "preload/adaptor/shared_object.h"

#include <gtest/gtest.h>

#include "tandem/plugin/key_file.h"

#include "bridge/bullet_rig.h"
#include "program/process.h"

namespace tandem::test {
namespace {

using preload::HostTime;
using preload::PreloadConfig;
using preload::SharedObject;

PreloadConfig makeConfig() {
  PreloadConfig config;
  config.index = 1;
  config.site.peers = 1;
  config.device.start_W = Vec3(-0.03, 0, 0);
  config.hand_force_W = Vec3(1, 0, 0);
  return config;
}

/// Steps as the interposer does.
void step(SharedObject& shared, BulletRig& rig) {
  const btScalar dt = btScalar(1) / 60;
  shared.beforeStep();
  const int sub_steps = rig.world.stepSimulation(dt, 1, dt);
  shared.afterStep(static_cast<double>(dt), 1, static_cast<double>(dt), sub_steps);
}

TEST(SharedObject, WaitsUntilItIsThereAndLetsGoWhenItLeaves) {
  BulletRig rig;
  SharedObject shared(makeConfig());
  shared.setWorld(rig.world);
  step(shared, rig);
  EXPECT_EQ(shared.site(), nullptr);

  btRigidBody& cube = rig.addCube(0.2);
  for (int i = 0; i < 20; ++i) step(shared, rig);
  ASSERT_NE(shared.site(), nullptr);
  EXPECT_GT(cube.getCenterOfMassPosition().x(), 0.01);

  shared.objectLeaves(&cube);
  rig.world.removeRigidBody(&cube);
  EXPECT_EQ(shared.site(), nullptr);
  btRigidBody& other = rig.addCube(0.3);
  step(shared, rig);
  EXPECT_EQ(shared.site(), nullptr) << "another mass is another body";
  rig.world.addRigidBody(&cube);
  step(shared, rig);
  ASSERT_NE(shared.site(), nullptr);
  EXPECT_EQ(&shared.site()->objectBody(0), &cube);
  EXPECT_NE(&shared.site()->objectBody(0), &other);
  shared.endWorld();
  EXPECT_EQ(shared.site(), nullptr);
}

TEST(SharedObject, MayBeACompound) {
  BulletRig rig;
  rig.addCube(0.2, 0.02, Vec3(0.0, 0.5, 0.0));
  auto& compound = rig.makeShape<btCompoundShape>();
  auto& box = rig.makeShape<btBoxShape>(toBullet(Vec3(0.02, 0.01, 0.02)));
  for (const double y : {-0.01, 0.01})
    compound.addChildShape(toBullet(Vec3(0.0, y, 0.0), Quat::Identity()), &box);
  btRigidBody& body = rig.addBody(compound, 0.2);
  PreloadConfig config = makeConfig();
  config.index.reset();
  config.shape = preload::parseShapeWords("compound");
  SharedObject shared(config);
  shared.setWorld(rig.world);
  for (int i = 0; i < 20; ++i) step(shared, rig);
  ASSERT_NE(shared.site(), nullptr);
  EXPECT_EQ(&shared.site()->objectBody(0), &body);
  EXPECT_GT(body.getCenterOfMassPosition().x(), 0.01);
}

// A program takes its bodies out at its end, too: the next step tells whether it runs on.
TEST(SharedObject, SaysThatItWasTakenOutInTheNextStepOnly) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.2);
  SharedObject shared(makeConfig());
  shared.setWorld(rig.world);
  const auto takeOut = [&] {
    shared.objectLeaves(&cube);
    rig.world.removeRigidBody(&cube);
  };
  const auto hear = [](const auto& act) {
    testing::internal::CaptureStderr();
    act();
    return testing::internal::GetCapturedStderr();
  };
  step(shared, rig);
  EXPECT_EQ(hear(takeOut), "");
  EXPECT_NE(hear([&] { step(shared, rig); }).find("taken out of world 1: waiting for it to come"),
            std::string::npos);
  EXPECT_EQ(hear([&] { step(shared, rig); }), "");
  rig.world.addRigidBody(&cube);
  step(shared, rig);
  takeOut();
  rig.world.addRigidBody(&cube);
  EXPECT_NE(hear([&] { step(shared, rig); }).find("taken out of world 1, and is back"),
            std::string::npos);
  takeOut();
  EXPECT_NE(hear([&] { shared.endWorld(); }).find("world 1 ends after 3 steps with the object"),
            std::string::npos);
  rig.world.addRigidBody(&cube);
}

TEST(SharedObject, LeavesAloneWhatWasThereBesides) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.2);
  btRigidBody& twin = rig.addCube(0.2, 0.02, Vec3(0, 1, 0));
  SharedObject shared(makeConfig());
  shared.setWorld(rig.world);
  step(shared, rig);
  shared.objectLeaves(&cube);
  rig.world.removeRigidBody(&cube);
  step(shared, rig);
  EXPECT_EQ(shared.site(), nullptr);
  // A body that is removed and added again counts as new.
  shared.objectLeaves(&twin);
  rig.world.removeRigidBody(&twin);
  rig.world.addRigidBody(&twin);
  step(shared, rig);
  ASSERT_NE(shared.site(), nullptr);
  EXPECT_EQ(&shared.site()->objectBody(0), &twin);
  shared.endWorld();
  rig.world.addRigidBody(&cube);
}

TEST(SharedObject, GivesBackWhatTheBodyHad) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.2);
  const TempFolder folder;
  makeKeyFile(folder / "k.psk");
  PreloadConfig config = makeConfig();
  config.site.peers = 2;
  config.site.link_loss.start_live = false;
  config.link.emplace();
  config.link->bind = resolveAddress("127.0.0.1:0");
  config.link->address = resolveAddress("127.0.0.1:9");
  config.link->key = folder / "k.psk";
  const btScalar inverse_mass = cube.getInvMass();
  const int bodies = rig.world.getNumCollisionObjects();
  SharedObject shared(config);
  shared.setWorld(rig.world);
  step(shared, rig);
  EXPECT_FLOAT_EQ(static_cast<float>(cube.getInvMass()), static_cast<float>(2 * inverse_mass));
  EXPECT_GT(rig.world.getNumCollisionObjects(), bodies) << "the other user's proxy";
  shared.endWorld();
  EXPECT_EQ(cube.getInvMass(), inverse_mass);
  EXPECT_EQ(rig.world.getNumCollisionObjects(), bodies);
}

TEST(SharedObject, GivesUpOnABodyThatCannotBeShared) {
  BulletRig rig;
  rig.addBody(rig.makeShape<btCompoundShape>(), 0.2);
  SharedObject shared(makeConfig());
  shared.setWorld(rig.world);
  for (int i = 0; i < 3; ++i) step(shared, rig);
  EXPECT_EQ(shared.site(), nullptr);
  shared.endWorld();
}

TEST(SharedObject, RefusesALogThatCannotBeWritten) {
  PreloadConfig config = makeConfig();
  config.log = "/no/such/folder/log.csv";
  EXPECT_THROW(SharedObject{config}, Error);
}

TEST(HostTime, CountsStepsOfOneLength) {
  HostTime time;
  for (int i = 0; i < 1000; ++i) time.advance(1.0 / 60.0, 0, 0.0, 1);
  EXPECT_EQ(time.now(), 1000 * (1.0 / 60.0));
  time.advance(0.1, 4, 1.0 / 240.0, 24);
  EXPECT_EQ(time.now(), 1000 * (1.0 / 60.0) + 4 * (1.0 / 240.0)) << "Bullet does no more";
  time.advance(0.001, 4, 1.0 / 240.0, 0);
  EXPECT_EQ(time.now(), 1000 * (1.0 / 60.0) + 4 * (1.0 / 240.0));
}

}  // namespace
}  // namespace tandem::test
