// The shipped scenario in which two users carry a block.

#include <string>

#include <gtest/gtest.h>

#include "demos/program/run/virtual_run.h"
#include "demos/program/scenario/scenario.h"
#include "support/checkout.h"

namespace tandem::demos {
namespace {

TEST(Carry, TwoUsersLiftAndCarryABlock) {
  const Scenario scenario = loadScenario(test::inCheckout("demos/scenarios/carry.toml"), {});
  VirtualRun run(scenario);
  run.run();
  constexpr std::size_t kCarried = 4500;  // [ms]
  for (int site = 0; site < 2; ++site) {
    const Recording& recording = run.recording(site);
    const Vec3 way_W = recording.object(kCarried, 0).island.p_W - recording.object(0, 0).island.p_W;
    EXPECT_NEAR(way_W.y(), 0.2, 0.01) << site;
    EXPECT_NEAR(way_W.z(), 0.08, 0.01) << site;
    // Each hand carries half.
    EXPECT_NEAR(recording.ticks()[kCarried].f_W.z(), -9.81, 0.5) << site;
  }
}

// One hand cannot.
TEST(Carry, OneUserDoesNot) {
  const Scenario scenario =
      loadScenario(test::inCheckout("demos/scenarios/carry.toml"), {"site2.grips=[]"});
  VirtualRun run(scenario);
  run.run();
  const Recording& recording = run.recording(0);
  EXPECT_LT(recording.object(4500, 0).island.p_W.z() - recording.object(0, 0).island.p_W.z(), 0.06);
}

}  // namespace
}  // namespace tandem::demos
