// Bodies that the script removes, unshares and shares again while a site is open.

#include "tandem/tandem.h"

#include "plugin_rig.h"

namespace tandem::test {
namespace {

TEST(RemovedBody, TakesWithItOnlyItself) {
  TwoShared two;
  const std::size_t pairs = two.host.engine.without_contact.size();
  EXPECT_EQ(pairs, 3u);
  EXPECT_EQ(two.status(), 0u);
  two.host.engine.remove(two.cube);
  two.host.step(60);
  EXPECT_TRUE(isSaid(two.host, "body 0 was removed"));
  EXPECT_TRUE(isSaid(two.host, "object 0 has no body: share one again with object=0"));
  EXPECT_EQ(two.host.read()[kHasEnded], 0.0);
  EXPECT_EQ(two.status(), static_cast<std::uint32_t>(TANDEM_STATUS_BODY_MISSING));
  // The other stands on the obstacle, and only its pair is filtered.
  EXPECT_NEAR(two.body(two.other).state.p_W.z(), 0.02, 2e-4);
  EXPECT_EQ(two.host.engine.without_contact.size(), 1u);

  StubBody next = makeStubCube();
  next.mass = 0.4;
  next.state.p_W = Vec3(0.0, 0.0, 0.03);
  const int number = two.host.engine.add(next);
  two.host.command("share object=0 body=" + std::to_string(number));
  two.host.step(120);
  EXPECT_FALSE(isSaid(two.host, "has no body"));
  EXPECT_DOUBLE_EQ(two.body(number).mass, 0.4);  // of one peer
  EXPECT_NEAR(two.body(number).state.p_W.z(), 0.02, 1e-3);
  EXPECT_NEAR(two.host.read()[kObjects + 2], 0.02, 1e-3);
  EXPECT_EQ(two.host.engine.without_contact.size(), 3u);
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
    EXPECT_TRUE(isSaid(shared.host, "another has its number")) << at_once;
    shared.host.command("close");
    EXPECT_EQ(shared.body().mass, 3.0);
    EXPECT_EQ(shared.body().linear_damping, 0.04);
  }
}

// PyBullet keeps a filter when a body goes, and the next body gets its number.
TEST(RemovedBody, LeavesNoFilterWhenTheSiteClosesAtOnce) {
  TwoShared two;
  two.host.engine.remove(two.cube);
  two.host.engine.add(makeStubCube());
  two.host.command("close");
  EXPECT_TRUE(two.host.engine.without_contact.empty());
}

// With a guide no object leaves alone: the site ends, and says so.
TEST(RemovedBody, EndsASiteWithAGuide) {
  SharedCube shared(makeStubCube(), "guide=1,0,0");
  shared.host.step(2);
  shared.host.engine.remove(shared.cube);
  shared.host.step(2);
  EXPECT_TRUE(isSaid(shared.host, "body 0 was removed"));
  EXPECT_EQ(shared.host.read()[kHasEnded], 1.0);
  EXPECT_NE(shared.host.refusal("share body=0").find("close"), std::string::npos);
  const int commands = shared.host.engine.commands;
  shared.host.step(2);
  EXPECT_EQ(shared.host.engine.commands, commands);
  shared.host.command("close");
}

TEST(UnsharedBody, IsPyBulletsAgainAndComesBack) {
  TwoShared two;
  two.body(two.cube).state.v_W = Vec3(0.3, 0.0, 0.0);
  two.host.step(2);
  const double speed = two.body(two.cube).state.v_W.x();
  two.host.command("unshare object=0");
  EXPECT_EQ(two.body(two.cube).linear_damping, 0.04);
  EXPECT_EQ(two.body(two.cube).state.v_W.x(), speed);
  EXPECT_EQ(two.host.engine.without_contact.size(), 1u);
  two.host.command("unshare object=0");  // again: nothing happens
  two.host.step(10);
  EXPECT_EQ(two.status(), 0u);
  EXPECT_NE(two.host.refusal("share object=1 body=0").find("has a body"), std::string::npos);
  EXPECT_NE(two.host.refusal("share object=7 body=0").find("no object 7"), std::string::npos);
  EXPECT_NE(two.host.refusal("unshare object=7").find("no object 7"), std::string::npos);
  two.host.command("share object=0 body=0");
  two.host.step(10);
  EXPECT_LT(two.body(two.cube).linear_damping, 1e-29);
  EXPECT_EQ(two.host.warnings(), "");
}

TEST(RemovedBody, ObstaclesAreMissedToo) {
  Pressed pressed;
  pressed.host.command("obstacle body=" + std::to_string(pressed.floor));
  pressed.host.engine.remove(pressed.floor);
  pressed.host.step(4);
  EXPECT_NE(pressed.host.warnings().find("body 1 was removed"), std::string::npos);
}

TEST(ResetSimulation, TakesAllBodiesAndTheSiteGoesOn) {
  TwoShared two;
  two.host.engine.reset();
  two.host.step(4);
  EXPECT_TRUE(isSaid(two.host, "object 0 has no body"));
  EXPECT_TRUE(isSaid(two.host, "object 1 has no body"));
  EXPECT_TRUE(
      isSaid(two.host, "body 1 was removed from PyBullet while attached: it is no obstacle"))
      << two.host.warnings();
  const int again = two.host.engine.add(makeStubCube());
  two.host.command("share object=1 body=" + std::to_string(again));
  two.host.step(2);
  EXPECT_EQ(two.host.read()[kHasEnded], 0.0);
  two.host.command("close");
  EXPECT_EQ(two.body(again).mass, 0.2);
}

}  // namespace
}  // namespace tandem::test
