// Maps and curves of stability: their numbers are those of the analysis, at the right places.

#include "demos/program/analyse/growth_map.h"

#include <atomic>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "demos/program/analyse/map_options.h"
#include "demos/program/analyse/stability_curves.h"
#include "demos/program/terminal/usage_error.h"
#include "stability/papers_loops.h"

namespace tandem {
namespace {

using namespace demos;

LoopSettings makeCoupled() { return test::makeFirstExperiment(StandInKind::kNone); }

void run(const Jobs& jobs) {
  runOnAllCores(jobs, [](double) {});
}

TEST(Jobs, AreAllDoneOnce) {
  std::vector<std::atomic<int>> done(1000);
  Jobs jobs;
  for (auto& one : done) jobs.emplace_back([&one] { ++one; });
  run(jobs);
  for (const auto& one : done) EXPECT_EQ(one, 1);
  run({});
}

TEST(Jobs, HandOnWhatOneThrows) {
  Jobs jobs(100, [] {});
  jobs[50] = [] { throw std::runtime_error("fifty"); };
  EXPECT_THROW(run(jobs), std::runtime_error);
}

TEST(GrowthMap, SpansAGainByRatiosAndTheDelayBySteps) {
  const LoopSettings loop = makeCoupled();
  const MapAxis gain = makeMapAxis(loop, LoopGain::kCoordinationStiffness, 5);
  EXPECT_TRUE(gain.is_logarithmic);
  EXPECT_NEAR(gain.values.front(), 2.0, 1e-9);  // [N/m]
  EXPECT_NEAR(gain.values.back(), 6000.0, 1e-6);
  EXPECT_NEAR(gain.values[1] / gain.values[0], gain.values[4] / gain.values[3], 1e-9);
  const MapAxis delay = makeMapAxis(loop, LoopGain::kDelay, 5);
  EXPECT_FALSE(delay.is_logarithmic);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_DOUBLE_EQ(delay.values[i], 0.05 * static_cast<double>(i));  // [s]
}

TEST(GrowthMap, HasRoomForLongDelaysAndGainsOfZero) {
  LoopSettings loop = makeCoupled();
  loop.delay = 0.15;
  EXPECT_NEAR(makeMapAxis(loop, LoopGain::kDelay, 2).values.back(), 0.3, 1e-12);  // [s]
  loop.delay = 0.4;
  EXPECT_EQ(makeMapAxis(loop, LoopGain::kDelay, 2).values.back(), kLongestDelay);
  loop.device_damping = loop.coordination.stiffness = 0.0;
  EXPECT_NEAR(makeMapAxis(loop, LoopGain::kDeviceDamping, 2).values.front(), 0.01, 1e-12);
  EXPECT_NEAR(makeMapAxis(loop, LoopGain::kCoordinationStiffness, 2).values.front(), 1.0, 1e-12);
}

TEST(GrowthMap, PointsAreTheWorstRatesThere) {
  const LoopSettings loop;
  GrowthMap map = makeMap(loop, LoopGain::kDelay, LoopGain::kContactStiffness, {4, 3});
  Jobs jobs;
  addMapJobs(map, jobs);
  run(jobs);
  ASSERT_EQ(map.rates.size(), 12u);
  for (std::size_t i = 0; i < map.rates.size(); ++i) {
    LoopSettings there = loop;
    there.delay = map.x.values[i % 4];
    there.contact.stiffness = map.y.values[i / 4];
    EXPECT_EQ(map.rates[i], computeWorstRate(there)) << i;
  }
}

// Runs of the simulator have their borders at 389.451 N/m and, over the delay, at 84.926 ms.
TEST(GrowthMap, BordersAreThoseOfRuns) {
  GrowthMap map =
      makeMap(makeCoupled(), LoopGain::kCoordinationStiffness, LoopGain::kDelay, {61, 5});
  Jobs jobs;
  addMapJobs(map, jobs);
  ASSERT_DOUBLE_EQ(map.y.values[1], 0.05);
  run(jobs);
  const std::vector<double>& stiffness = map.x.values;
  for (std::size_t i = 0; i < stiffness.size(); ++i)
    EXPECT_EQ(map.rates[stiffness.size() + i] < 0.0, stiffness[i] < 389.451) << stiffness[i];

  LoopSettings late = makeCoupled();
  for (const double delay : {0.0848, 0.0850}) {
    late.delay = delay;
    EXPECT_EQ(computeWorstRate(late) < 0.0, delay < 0.084926);
  }
}

TEST(GrowthMap, CsvHasALineForEachPoint) {
  GrowthMap map = makeMap(makeCoupled(), LoopGain::kDelay, LoopGain::kContactDamping, {2, 2});
  map.rates = {-1.0, 2.5, 3.0, -0.125};
  EXPECT_EQ(writeCsv(map),
            "network.delay,contact.damping,rate\n0,0.01,-1\n0.2,0.01,2.5\n0,30,3\n0.2,30,-0.125\n");
}

TEST(MapOptions, AreTwoGainsAndTheirPoints) {
  const auto [x, y] = parseMapGains("network.delay,device.damping");
  EXPECT_EQ(x, LoopGain::kDelay);
  EXPECT_EQ(y, LoopGain::kDeviceDamping);
  EXPECT_EQ(parseMapSize("7").y, 7u);
  EXPECT_EQ(parseMapSize("400x2").x, 400u);
  EXPECT_EQ(parseMapSize("400x2").y, 2u);
  for (const char* gains : {"", "network.delay", "network.delay,", "network.delay,object.mass",
                            "network.delay,network.delay", "network.delay, device.damping",
                            "network.delay,device.damping,contact.damping"})
    EXPECT_THROW((void)parseMapGains(gains), UsageError) << gains;
  for (const char* points : {"", "1", "401", "-3", "x", "5x", "x5", "5x1", "5x5x5", "6.5", "1e2"})
    EXPECT_THROW((void)parseMapSize(points), UsageError) << points;
}

/// Values of one curve at some delays; the others are not computed.
std::vector<double> computeAt(void (*addJobs)(const LoopSettings&, CurveSet&, Jobs&),
                              const LoopSettings& loop, std::size_t curve,
                              const std::vector<double>& delays) {
  CurveSet set{delays, {}};
  Jobs jobs;
  addJobs(loop, set, jobs);
  for (std::size_t i = 0; i < delays.size(); ++i) jobs[curve * delays.size() + i]();
  std::vector<double> values;
  for (const auto& value : set.curves[curve].values) values.push_back(value.value_or(NAN));
  return values;
}

void expectNear(const std::vector<double>& values, const std::vector<double>& expected,
                double error) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], expected[i], error) << i;
}

// [N s/m], at 10, 20, 50, 100 and 200 ms.
TEST(StabilityCurves, DampingIsWhatEachSchemeNeeds) {
  const std::vector<double> delays = {0.01, 0.02, 0.05, 0.1, 0.2};
  const LoopSettings first;
  expectNear(computeAt(addDampingJobs, first, 0, delays), {0.0, 0.0, 0.0, 0.63, 1.11}, 0.01);
  expectNear(computeAt(addDampingJobs, first, 1, delays), {7.1, 9.0, 12.8, 12.9, 13.2}, 0.06);
  expectNear(computeAt(addDampingJobs, first, 2, delays), {2.3, 1.7, 2.4, 2.3, 2.0}, 0.06);
  const LoopSettings second = test::makeSecondExperiment(StandInKind::kDynamic);
  expectNear(computeAt(addDampingJobs, second, 0, delays), {14.6, 17.2, 18.7, 19.4, 19.4}, 0.06);
  expectNear(computeAt(addDampingJobs, second, 1, delays), {0.0, 0.0, 1.14, 2.68, 3.25}, 0.01);
}

// [1/s], for 2, 3, 4, 6, 8, 12 and 16 users at 20 ms.
TEST(StabilityCurves, UsersNeedTheAverageWithSharedProxies) {
  LoopSettings loop;
  loop.delay = 0.02;
  CurveSet set;
  Jobs jobs;
  addUserJobs(loop, set, jobs);
  run(jobs);
  const std::vector<std::vector<double>> expected = {{-6.5, -1.2, 0.68, 0.83, 0.42, 0.05, -0.06},
                                                     {-8.3, -7.5, -7.2, -6.9, -6.8, -6.7, -6.7},
                                                     {-2.6, 1.4, 0.80, -0.98, -0.45, 0.01, 0.22},
                                                     {-3.5, -5.5, -4.6, -3.9, -3.6, -3.2, -3.1},
                                                     {-3.5, 3.2, 7.7, 12.2, 14.4, 16.5, 17.5}};
  ASSERT_EQ(set.curves.size(), expected.size());
  for (std::size_t c = 0; c < expected.size(); ++c)
    for (std::size_t i = 0; i < set.x.size(); ++i)
      EXPECT_NEAR(set.curves[c].values[i].value(), expected[c][i], 0.06)
          << set.curves[c].name << " of " << set.x[i];
}

TEST(StabilityCurves, LimitsAreTheExactBorders) {
  const std::vector<double> delays = {0.02, 0.05, 0.1, 0.2};
  expectNear(computeAt(addCoordinationLimitJobs, LoopSettings(), 0, delays),
             {1598.3, 389.5, 178.8, 104.5}, 0.1);
  expectNear(
      computeAt(addContactLimitJobs, test::makeSecondExperiment(StandInKind::kHeld), 0, delays),
      {97.2, 42.99, 22.42, 12.49}, 0.06);
  CurveSet none;
  Jobs jobs;
  addCoordinationLimitJobs(test::makeSecondExperiment(StandInKind::kHeld), none, jobs);
  EXPECT_TRUE(none.curves.empty() && jobs.empty());
}

// The rate over 50 ms and half a packet both ways is from -0.805 to -0.278 1/s.
TEST(StabilityCurves, FineStepsAreAroundTheDelay) {
  CurveSet set;
  Jobs jobs;
  addFineJobs(makeCoupled(), set, jobs);
  EXPECT_NEAR(set.x.front(), 0.05 - 2.0 / 128.0, 1e-12);  // [s]
  EXPECT_NEAR(set.x[1] - set.x[0], 0.25e-3, 1e-12);
  ASSERT_EQ(set.curves.size(), 3u);
  ASSERT_EQ(set.curves[0].name, "virtual_coupling");
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t i = 0; i < set.x.size(); ++i) {
    if (std::abs(set.x[i] - 0.05) > 0.5 / 128.0) continue;
    jobs[i]();
    least = std::min(least, set.curves[0].values[i].value());
    most = std::max(most, set.curves[0].values[i].value());
  }
  EXPECT_NEAR(least, -0.805, 0.02);
  EXPECT_NEAR(most, -0.278, 0.06);
}

}  // namespace
}  // namespace tandem
