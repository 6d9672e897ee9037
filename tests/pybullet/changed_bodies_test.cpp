// Bodies that the script removes or changes while a site has them.

#include "plugin_rig.h"

namespace tandem::test {
namespace {

TEST(RemovedBody, EndsTheSiteWithAMessage) {
  SharedCube shared;
  shared.host.step(2);
  shared.host.engine.remove(shared.cube);
  shared.host.step(2);
  EXPECT_NE(shared.host.warnings().find("body 0 was removed"), std::string::npos);
  EXPECT_EQ(shared.host.read()[kHasEnded], 1.0);
  EXPECT_NE(shared.host.refusal("share body=0").find("close"), std::string::npos);
  const int commands = shared.host.engine.commands;
  shared.host.step(2);
  EXPECT_EQ(shared.host.engine.commands, commands);
  shared.host.command("close");
}

// Another body has the removed one's number, pose and velocity. It is neither moved nor changed.
TEST(RemovedBody, IsNotMistakenForTheNextOfItsNumber) {
  for (const bool at_once : {true, false}) {
    SharedCube shared;
    if (!at_once) shared.host.step(2);
    StubBody other = makeStubCube();
    other.mass = 3.0;
    shared.host.engine.remove(shared.cube);
    EXPECT_EQ(shared.host.engine.add(other), shared.cube);
    shared.host.step(2);
    EXPECT_EQ(shared.host.read()[kHasEnded], 1.0) << at_once;
    EXPECT_NE(shared.host.warnings().find("another has its number"), std::string::npos);
    shared.host.command("close");
    EXPECT_EQ(shared.body().mass, 3.0);
    EXPECT_EQ(shared.body().linear_damping, 0.04);
  }
}

TEST(RemovedBody, ObstaclesAreMissedToo) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  pressed.host.engine.remove(pressed.floor);
  pressed.host.step(4);
  EXPECT_NE(pressed.host.warnings().find("body 1 was removed"), std::string::npos);
}

TEST(ResetSimulation, EndsTheSiteWithAMessage) {
  SharedCube shared;
  shared.host.engine.reset();
  shared.host.step();
  EXPECT_NE(shared.host.warnings().find("was removed"), std::string::npos);
  shared.host.engine.add(makeStubCube());
  shared.host.command("close");
  EXPECT_EQ(shared.body().mass, 0.2);
}

TEST(ChangedBody, KeepsTheUsersDampingForLater) {
  SharedCube shared;
  shared.body().linear_damping = 0.2;
  shared.body().state.v_W.x() = 0.1;
  shared.host.step(2);
  EXPECT_NE(shared.host.warnings().find("damping was set"), std::string::npos);
  EXPECT_EQ(shared.host.read()[kHasEnded], 0.0);
  EXPECT_LT(shared.body().linear_damping, 1e-29);
  shared.host.command("close");
  EXPECT_EQ(shared.body().linear_damping, 0.2);
  EXPECT_EQ(shared.body().angular_damping, 0.04);
}

// Setting both dampings in one call removes two marks, and it is still the same body.
TEST(ChangedBody, MayBeGivenBothDampingsAtOnce) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  const StubBody cube = pressed.host.engine.bodies.at(pressed.cube);
  for (const int number : {pressed.cube, pressed.floor}) {
    StubBody& body = pressed.host.engine.bodies.at(number);
    body.linear_damping = body.angular_damping = 0.1;
  }
  pressed.host.step(4);
  EXPECT_EQ(pressed.host.read()[kHasEnded], 0.0) << pressed.host.warnings();
  for (const char* body : {"body 0: damping was set", "body 1: damping was set"}) {
    EXPECT_NE(pressed.host.warnings().find(body), std::string::npos) << body;
  }
  pressed.host.command("close");
  for (const int number : {pressed.cube, pressed.floor}) {
    const StubBody& body = pressed.host.engine.bodies.at(number);
    EXPECT_EQ(body.linear_damping, 0.1) << number;
    EXPECT_EQ(body.angular_damping, 0.1) << number;
    EXPECT_EQ(body.friction, 0.5) << number;
    EXPECT_EQ(body.restitution, 0.0) << number;
  }
  EXPECT_EQ(pressed.host.engine.bodies.at(pressed.cube).mass, cube.mass);
}

// All that changeDynamics() may set of a multibody, in one call: it is still the same body.
TEST(ChangedBody, MayBeGivenEverythingAtOnce) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  for (const int number : {pressed.cube, pressed.floor}) {
    StubBody& body = pressed.host.engine.bodies.at(number);
    if (number == pressed.cube) body.mass = 1.0;
    body.linear_damping = body.angular_damping = 0.1;
    body.friction = 0.9;
    body.restitution = 0.3;
  }
  pressed.host.step(4);
  EXPECT_EQ(pressed.host.read()[kHasEnded], 0.0) << pressed.host.warnings();
  for (const char* says : {"body 0: damping was set", "body 0: friction or restitution was set",
                           "body 0: mass was set", "body 1: friction or restitution was set"}) {
    EXPECT_NE(pressed.host.warnings().find(says), std::string::npos) << says;
  }
  EXPECT_EQ(pressed.host.warnings().find("was removed"), std::string::npos);
  pressed.host.command("close");
  for (const int number : {pressed.cube, pressed.floor}) {
    const StubBody& body = pressed.host.engine.bodies.at(number);
    EXPECT_EQ(body.linear_damping, 0.1) << number;
    EXPECT_EQ(body.angular_damping, 0.1) << number;
    EXPECT_EQ(body.friction, 0.9) << number;
    EXPECT_EQ(body.restitution, 0.3) << number;
    EXPECT_EQ(body.contact_threshold, 1e18) << number;
  }
  EXPECT_EQ(pressed.host.engine.bodies.at(pressed.cube).mass, 0.2);
}

TEST(ChangedBody, KeepsTheUsersContactThreshold) {
  for (const double threshold : {0.01, 0.0}) {
    SharedCube shared;
    shared.body().contact_threshold = threshold;
    shared.host.step(2);
    EXPECT_NEAR(shared.body().contact_threshold, threshold, 1e-7 * threshold);
    shared.host.command("close");
    EXPECT_EQ(shared.body().contact_threshold, threshold);
  }
}

// PyBullet tells less of a body with maximal coordinates. The message says that it may be the same.
TEST(ChangedBody, IsNotKnownAgainWithMaximalCoordinates) {
  StubBody cube = makeStubCube();
  cube.is_multibody = false;
  PluginHost host;
  host.engine.add(cube);
  host.command(kFarHand);
  host.command("site");
  host.command("share body=0 shape=box size=0.02,0.02,0.02");
  StubBody& body = host.engine.bodies.at(0);
  body.linear_damping = body.angular_damping = 0.1;
  body.friction = 0.9;
  host.step(2);
  EXPECT_EQ(host.read()[kHasEnded], 1.0);
  EXPECT_NE(host.warnings().find("or its friction and both dampings were set at once"),
            std::string::npos)
      << host.warnings();
}

// PyBullet does not report the restitution of a body with maximal coordinates: it stays unchanged.
TEST(ChangedBody, KeepsARestitutionThatIsNotTold) {
  StubBody cube = makeStubCube();
  cube.is_multibody = false;
  cube.restitution = 0.4;
  PluginHost host;
  host.engine.add(cube);
  host.command(kFarHand);
  host.command("site");
  host.command("share body=0 shape=box size=0.02,0.02,0.02");
  StubBody& body = host.engine.bodies.at(0);
  host.step(4);
  EXPECT_EQ(host.warnings(), "");
  body.linear_damping = body.angular_damping = 0.1;
  host.step(2);
  EXPECT_EQ(host.read()[kHasEnded], 0.0);
  host.command("close");
  EXPECT_EQ(body.restitution, 0.4);
  EXPECT_EQ(body.friction, 0.5);
  EXPECT_EQ(body.mass, 0.2);
}

TEST(ChangedBody, KeepsTheUsersFrictionAndRestitution) {
  SharedCube shared;
  EXPECT_NEAR(shared.body().friction, 0.5, 1e-7);
  EXPECT_LT(shared.body().restitution, 1e-29);
  for (const double friction : {0.3, 0.0, 0.7}) {
    shared.body().friction = friction;
    shared.body().restitution = 0.2;
    shared.host.step(2);
    EXPECT_NEAR(shared.body().friction, friction, 1e-7);
  }
  EXPECT_NE(shared.host.warnings().find("friction or restitution was set"), std::string::npos);
  EXPECT_EQ(shared.host.read()[kHasEnded], 0.0);
  shared.host.command("close");
  EXPECT_EQ(shared.body().friction, 0.7);
  EXPECT_EQ(shared.body().restitution, 0.2);
}

TEST(ChangedBody, KeepsItsShareOfTheMass) {
  SharedCube shared;
  shared.body().mass = 1.0;
  shared.host.step(2);
  EXPECT_NE(shared.host.warnings().find("mass was set"), std::string::npos);
  EXPECT_DOUBLE_EQ(shared.body().mass, 0.1);
}

}  // namespace
}  // namespace tandem::test
