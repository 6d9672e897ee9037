// Three, four and eight users by average: as stable as predicted, and with the predicted drag.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

#include "stability/drawn/pressed_sites.h"
#include "stability/drawn/simulated_growth.h"

namespace tandem {
namespace {

struct AveragedCase {
  StandInKind stand_in = StandInKind::kNone;
  int users = 3;
  test::Keeping keeping = test::Keeping::kGuide;
};

LoopSettings makeLoop(const AveragedCase& c) {
  LoopSettings settings;
  settings.stand_in = c.stand_in;
  settings.users = c.users;
  settings.object_mass = 0.1 * c.users;
  settings.mode = CoordinationMode::kAverage;
  settings.delay = 0.05;
  // Free proxies need more than a Falcon's own friction.
  if (c.stand_in == StandInKind::kDynamic) settings.device_damping = 5.0;
  return settings;
}

class AveragedUsers : public ::testing::TestWithParam<AveragedCase> {};

TEST_P(AveragedUsers, AreStableForTwentySeconds) {
  const LoopSettings settings = makeLoop(GetParam());
  const double predicted = computeWorstRate(settings);
  const auto seen = test::simulateGrowth(settings, 20.0, GetParam().keeping);
  ASSERT_TRUE(seen);
  const test::FittedGrowth& worst = seen->worst();
  fmt::print("predicted {:+.6g} 1/s, seen {:+.6g} +- {:.1g} for {:g} s\n", predicted, worst.rate,
             worst.spread, seen->duration);
  EXPECT_LT(predicted, 0.0);
  EXPECT_DOUBLE_EQ(seen->duration, 20.0);
  if (GetParam().keeping != test::Keeping::kNothing) {
    EXPECT_NEAR(worst.rate, predicted, 0.01 * std::abs(predicted));
    return;
  }
  // A cube that turns has slower modes, which a line has not. They must fade as well.
  EXPECT_LT(worst.rate, 0.0);
  EXPECT_NEAR(seen->common.rate, predicted, 0.2 * std::abs(predicted));
}

/// Force over speed of each user, if all are pulled alike.
double measureDrag(const LoopSettings& settings, test::Keeping keeping) {
  constexpr double kSettled = 5.0, kEnd = 11.0, kMean = 2.0, kPull = 0.02;  // [s], [N]
  test::PressedSites still(settings, {}, keeping), pulled(settings, {}, keeping);
  double sum = 0.0, least_depth = HUGE_VAL;
  long ticks = 0;
  while (still.now() < kEnd) {
    if (still.now() >= kSettled) pulled.pull(kPull);
    still.tick();
    pulled.tick();
    if (pulled.now() > kSettled) least_depth = std::min(least_depth, pulled.findLeastDepth());
    if (pulled.now() < kEnd - kMean) continue;
    sum += (pulled.velocities() - still.velocities()).head(settings.users).mean();
    ++ticks;
  }
  EXPECT_GT(least_depth, 0.0);
  return kPull * static_cast<double>(ticks) / sum;
}

TEST_P(AveragedUsers, HaveThePredictedDrag) {
  const LoopSettings settings = makeLoop(GetParam());
  const double predicted = computeDrag(settings);
  const double seen = measureDrag(settings, GetParam().keeping);
  fmt::print("predicted {:.6g} N s/m, seen {:.6g}\n", predicted, seen);
  EXPECT_NEAR(seen, predicted, 0.05 * predicted);
}

constexpr const char* kKeepings[] = {"guided", "kept_on_line", "free"};

std::string nameOfCase(const ::testing::TestParamInfo<AveragedCase>& info) {
  const AveragedCase& c = info.param;
  return fmt::format("{}_{}_{}", c.stand_in == StandInKind::kNone ? "coupled" : "dynamic", c.users,
                     kKeepings[static_cast<int>(c.keeping)]);
}

std::vector<AveragedCase> makeCases() {
  std::vector<AveragedCase> cases;
  for (const StandInKind stand_in : {StandInKind::kNone, StandInKind::kDynamic})
    for (const int users : {3, 4, 8})
      for (const auto keeping :
           {test::Keeping::kGuide, test::Keeping::kFactors, test::Keeping::kNothing})
        cases.push_back({stand_in, users, keeping});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Users, AveragedUsers, ::testing::ValuesIn(makeCases()), nameOfCase);

}  // namespace
}  // namespace tandem
