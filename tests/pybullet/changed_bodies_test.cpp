// Bodies that the script changes while a site has them.

#include <functional>

#include "plugin_rig.h"

namespace tandem::test {
namespace {

// A pinned body is PyBullet's; a wall that gets a mass is no obstacle any more.
TEST(ChangedBody, IsLeftToPyBulletWhenItIsPinned) {
  TwoShared two;
  two.body(two.cube).mass = 0.0;
  two.body(two.floor).mass = 5.0;
  two.host.step(4);
  EXPECT_TRUE(isSaid(two.host, "body 0 was made static"));
  EXPECT_TRUE(isSaid(two.host, "body 1 was given a mass: it is no obstacle any more"));
  EXPECT_EQ(two.body(two.cube).mass, 0.0);
  EXPECT_EQ(two.body(two.cube).linear_damping, 0.04);
  EXPECT_EQ(two.body(two.floor).mass, 5.0);
  EXPECT_TRUE(two.host.engine.without_contact.empty());
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
  for (const char* says : {"body 0: damping was set", "body 1: damping was set"}) {
    EXPECT_TRUE(isSaid(pressed.host, says)) << says;
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
  EXPECT_EQ(pressed.host.engine.bodies.at(pressed.cube).mass, 1.0);
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
  EXPECT_EQ(host.read()[kHasEnded], 0.0);
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
  EXPECT_EQ(shared.host.warnings(), "");
  shared.host.command("close");
  EXPECT_EQ(shared.body().friction, 0.7);
  EXPECT_EQ(shared.body().restitution, 0.2);
}

// changeDynamics() sets the whole mass and, with it, the inertia; half of them stay with the copy.
TEST(ChangedBody, CarriesItsShareOfANewMass) {
  SharedCube shared;
  shared.host.step(2);
  shared.body().mass = 1.0;
  shared.body().inertia *= 10.0;  // 5 times that of the cube
  const Vec3 inertia = shared.body().inertia;
  shared.host.step(2);
  EXPECT_EQ(shared.host.warnings(), "");
  EXPECT_DOUBLE_EQ(shared.body().mass, 0.5);
  EXPECT_LT((shared.body().inertia - 0.5 * inertia).norm(), 1e-18);
  shared.body().hit = Vec3(0.05, 0.0, 0.0);  // in PyBullet, on 0.5 kg
  shared.host.step(3);
  EXPECT_NEAR(shared.body().state.v_W.x(), 0.1, 1e-12);
  shared.body().inertia *= 3.0;  // alone
  shared.host.step(2);
  EXPECT_DOUBLE_EQ(shared.body().mass, 0.5);
  shared.host.command("close");
  EXPECT_DOUBLE_EQ(shared.body().mass, 1.0);
  EXPECT_LT((shared.body().inertia - 1.5 * inertia).norm(), 1e-18);
}

// Its weight acts once in the step in which Tandem follows the change: half of it on half the mass.
TEST(ChangedBody, FallsAsBefore) {
  const auto change_friction = [](SharedCube& shared) { shared.body().friction = 0.3; };
  const auto change_mass = [](SharedCube& shared) { shared.body().mass = 0.3; };
  const auto share_again = [](SharedCube& shared) {
    shared.host.command("unshare object=0");
    shared.host.command("share body=0 object=0");
  };
  const std::vector<std::function<void(SharedCube&)>> changes{change_friction, change_mass,
                                                              share_again};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SharedCube shared;
    shared.host.engine.gravity = Vec3(0.0, 0.0, -9.81);
    shared.host.engine.time_step = 0.01;
    shared.host.step(5);
    changes[i](shared);
    shared.host.step(5);
    EXPECT_NEAR(shared.body().state.v_W.z(), -0.981, 1e-12) << i;
  }
}

// A pair has the product of its frictions. A slope of 10 degrees holds a cube with 0.5 on a floor
// with 0.5, and not with 0.1.
TEST(ChangedBody, SlidesWithTheUsersNewFriction) {
  TwoShared two;
  const double angle = 10.0 * M_PI / 180.0;
  two.host.engine.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  two.host.step(120);
  EXPECT_LT(two.body(two.cube).state.v_W.norm(), 1e-3);
  two.body(two.cube).friction = 0.1;
  two.host.step(96);
  // v = (sin a - mu cos a) g t, of which the first two steps may be missing.
  const double a = 9.81 * (std::sin(angle) - 0.05 * std::cos(angle));
  EXPECT_NEAR(two.body(two.cube).state.v_W.x(), a * 0.4, a * 3.0 / 240.0);
  EXPECT_LT(two.body(two.other).state.v_W.norm(), 1e-3);
  EXPECT_EQ(two.host.warnings(), "");
}

TEST(ChangedBody, SaysThatContactStiffnessDoesNotAct) {
  SharedCube shared;
  shared.body().contact_stiffness = 1e4;
  shared.host.step(2);
  EXPECT_TRUE(isSaid(shared.host, "body 0: contact stiffness was set"));
}

}  // namespace
}  // namespace tandem::test
