// A network that is cut for a while. Forces on the hands are continuous, and recover afterwards.

#include <cmath>

#include <gtest/gtest.h>

#include "physics/link_loss_scene.h"

namespace tandem {
namespace {

using test::OutageCase;
using test::OutageRun;
using test::Phase;

struct SchemeAndPhase {
  const char* scheme;
  Phase phase;
  bool is_guided;
};

class Outage : public ::testing::TestWithParam<SchemeAndPhase> {
 protected:
  [[nodiscard]] static OutageCase makeCase(double outage) {
    const auto& [scheme, phase, is_guided] = GetParam();
    return {scheme, phase, is_guided, outage};
  }
};

/// A force grows no faster than its spring K_vc is compressed. Hand and body approach each other,
/// each no faster than this [m/s].
constexpr double kFastest = 0.1;
constexpr double kContactStiffness = 4000.0;

TEST_P(Outage, IsFeltWithoutAJerkAndLeavesNoTrace) {
  OutageRun undisturbed(makeCase(0.0));
  undisturbed.run();
  ASSERT_EQ(undisturbed.status, kTickOk);
  const double limit = undisturbed.largestStep() +
                       kContactStiffness * 2.0 * kFastest * OutageRun::kPeriod +
                       undisturbed.largestForce() * OutageRun::kPeriod / 0.15;
  double most = 0.0;
  for (const double outage : {0.05, 0.1, 0.25, 1.0, 5.0}) {
    SCOPED_TRACE(outage);
    OutageRun run(makeCase(outage));
    run.run();
    ASSERT_EQ(run.status, kTickOk);
    most = std::max(most, run.largestStep());
    EXPECT_LT(run.largestStep(), limit);
    const std::size_t end = run.forces[0].size() - 1;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(run.states[i][end], LinkState::kLive);
      // Hands stand or move evenly, so any late sample of the undisturbed run is the same.
      const std::size_t same = undisturbed.forces[i].size() - 1;
      EXPECT_NEAR(run.forces[i][end], undisturbed.forces[i][same],
                  0.02 + 0.05 * std::abs(undisturbed.forces[i][same]));
    }
    // The silence is longer than the outage by up to a packet period.
    const SiteCounters& counters = run.sites[0]->counters();
    EXPECT_EQ(counters.links_lost, outage > 0.245 ? 1u : 0u);
    EXPECT_EQ(counters.links_rejoined, counters.links_lost);
    EXPECT_EQ(counters.links_faded, outage > 0.095 ? 1u : 0u);
  }
  RecordProperty("largest_step_mN", static_cast<int>(std::lround(1e3 * most)));
  RecordProperty("limit_mN", static_cast<int>(std::lround(1e3 * limit)));
}

TEST_P(Outage, OfARemoteThatIsLostNothingIsFelt) {
  OutageRun run(makeCase(1.0));
  run.run();
  const std::size_t lost = OutageRun::tickAt(OutageRun::kCutFrom + OutageRun::kDelay + 0.25 + 0.01);
  const std::size_t back = OutageRun::tickAt(OutageRun::kCutFrom + 1.0);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(run.states[i][lost], LinkState::kLost);
    if (GetParam().phase != Phase::kMeeting) continue;
    for (std::size_t k = lost; k < back; ++k) ASSERT_EQ(run.forces[i][k], 0.0) << k;
  }
  if (GetParam().phase == Phase::kPushing) {
    // Only the drag of the local copy is left.
    EXPECT_NEAR(run.forces[0][back], -OutageRun::kObjectDamping * OutageRun::kPushSpeed, 1e-3);
  }
}

TEST_P(Outage, IsEqualToTheBitEachTime) {
  OutageRun first(makeCase(0.25)), second(makeCase(0.25));
  first.run(), second.run();
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(first.sites[i]->stateHash(), second.sites[i]->stateHash());
}

std::vector<SchemeAndPhase> allCases() {
  std::vector<SchemeAndPhase> all;
  for (const char* scheme : {"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"})
    for (const Phase phase : {Phase::kFree, Phase::kPushing, Phase::kHolding, Phase::kMeeting})
      for (const bool is_guided : {true, false}) all.push_back({scheme, phase, is_guided});
  return all;
}

std::string nameCase(const ::testing::TestParamInfo<SchemeAndPhase>& info) {
  constexpr const char* kPhases[] = {"free", "pushing", "holding", "meeting"};
  return std::string(info.param.scheme) + "_" + kPhases[static_cast<int>(info.param.phase)] +
         (info.param.is_guided ? "_guided" : "");
}

INSTANTIATE_TEST_SUITE_P(AllSchemes, Outage, ::testing::ValuesIn(allCases()), nameCase);

}  // namespace
}  // namespace tandem
