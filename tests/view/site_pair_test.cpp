// Both sites in one thread, and between haptic threads and that. No wall time is asserted.

#include "session/site_pair.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"

#include "run/virtual_run.h"
#include "view/own_world.h"

namespace tandem::view {
namespace {

demos::Scenario loadCube(double duration) {
  return tandem::test::loadWorld("cube", {"experiment.duration=" + std::to_string(duration)});
}

TEST(SitePair, TicksInVirtualTimeAsTheVirtualRunToTheBit) {
  const demos::Scenario scenario = loadCube(2.0);
  demos::VirtualRun run(scenario);
  run.run();
  SitePair pair(scenario);
  while (pair.nextTick() < 2000) pair.tick();
  EXPECT_EQ(pair.own().site().stateHash(), run.world(0).site().stateHash());
  EXPECT_EQ(pair.other().site().stateHash(), run.world(1).site().stateHash());
}

TEST(SitePair, OneStepIsOneHostPeriod) {
  const demos::Scenario scenario = loadCube(2.0);
  SitePair pair(scenario);
  for (std::uint64_t step = 1; step <= 180; ++step) {
    pair.tickOneHostStep();
    EXPECT_EQ(pair.own().site().counters().host_steps, step);
    EXPECT_EQ(pair.nextTick(), static_cast<std::uint64_t>(
                                   std::ceil(static_cast<double>(step) * 1000.0 / 60.0 - 1e-6)));
  }
}

// In the world plank both scripted hands hold an end from 0.5 s on. A mouse's button was overruled,
// and its hand took hold and let go with each host step.
TEST(SitePair, AUsersOwnGripOverrulesTheScenarios) {
  SitePair pair(tandem::test::loadWorld("plank"));
  int held = 0;
  while (pair.time() < 1.0) {
    pair.tick();
    pair.own().hold(false);
    held += pair.own().site().grip().has_value();
  }
  EXPECT_EQ(held, 0);
  EXPECT_TRUE(pair.other().site().grip()) << "user 2's hand is the scenario's";
}

// User 1 pushes the cube from 0.5 s on. Threads take over and give back; the push goes on.
TEST(SitePair, GoesOnWithThreadsAndWithoutThem) {
  const demos::Scenario scenario = loadCube(6.0);
  SitePair pair(scenario);
  while (pair.time() < 1.2) pair.tick();
  const double force = pair.own().site().force().norm();
  const Vec3 hip_W = pair.own().site().hip().p_W;
  ASSERT_GT(force, 0.2);

  pair.start();
  while (pair.loop().report().ticks < 10) sleepFor(1e-3);
  double live_force = 0.0;
  pair.own().site().betweenTicks([&] { live_force = pair.own().site().force().norm(); });
  EXPECT_GT(live_force, 0.25 * force) << "the force goes on from there";
  pair.stop();
  EXPECT_FALSE(pair.isLive());
  EXPECT_EQ(pair.own().site().force(), Vec3::Zero());
  EXPECT_GE(pair.time(), 1.21);

  for (int tick = 0; tick < 20; ++tick) pair.tick();
  EXPECT_GT(pair.own().site().force().norm(), 0.25 * force) << "the force is back";
  EXPECT_LT((pair.own().site().hip().p_W - hip_W).norm(), 0.1) << "the hand did not jump";
  EXPECT_EQ(pair.own().site().status(), kTickOk);
  EXPECT_EQ(pair.other().site().status(), kTickOk);
}

}  // namespace
}  // namespace tandem::view
