// Advice: borders of gains, what to turn, and what that gives.
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

namespace tandem {
namespace {

const GainMargin& marginOf(const Advice& advice, LoopGain gain) {
  for (const GainMargin& margin : advice.margins)
    if (margin.gain == gain) return margin;
  throw std::logic_error("no such gain");
}

TEST(Advice, BordersAreThoseOfRuns) {
  LoopSettings coupled;
  coupled.stand_in = StandInKind::kNone;
  const Advice advice = advise(coupled);
  EXPECT_LT(advice.worst().growth.rate, 0.0);
  const GainMargin& stiffness = marginOf(advice, LoopGain::kCoordinationStiffness);
  EXPECT_FALSE(stiffness.below);
  EXPECT_NEAR(stiffness.above.value(), 389.451, 1e-4 * 389.451);
  const GainMargin& damping = marginOf(advice, LoopGain::kCoordinationDamping);
  EXPECT_NEAR(damping.below.value(), 8.41134, 1e-4 * 8.41134);
  EXPECT_NEAR(damping.above.value(), 38.4306, 1e-4 * 38.4306);
  EXPECT_NEAR(marginOf(advice, LoopGain::kDelay).above.value(), 0.0849262, 1e-5);
  EXPECT_FALSE(advice.remedy);
  EXPECT_EQ(advice.largest_coordination_stiffness, stiffness.above);
}

// Whatever is unstable: the change that is advised calms it, and a border is one.
TEST(Advice, IsWhatItSays) {
  for (const StandInKind kind : {StandInKind::kHeld, StandInKind::kDynamic}) {
    for (const int users : {2, 4}) {
      LoopSettings settings;
      settings.stand_in = kind;
      settings.users = users;
      settings.object_mass = 0.1 * users;
      settings.mode = CoordinationMode::kAverage;
      const Advice advice = advise(settings);
      const bool is_stable = advice.worst().growth.rate < 0.0;
      for (const GainMargin& margin : advice.margins) {
        for (const auto& border : {margin.below, margin.above}) {
          if (!border) continue;
          LoopSettings there = settings;
          setValue(there, margin.gain, *border * (border == margin.above ? 1.001 : 0.999));
          EXPECT_NE(computeWorstRate(there) < 0.0, is_stable) << name(margin.gain);
        }
      }
      if (!advice.remedy) continue;
      LoopSettings calmed = settings;
      setValue(calmed, advice.remedy->gain, advice.remedy->value);
      EXPECT_LT(computeWorstRate(calmed), 0.0);
    }
  }
}

TEST(Advice, SlopesAreThoseOfTheRate) {
  LoopSettings settings;
  for (const LoopGain gain : allLoopGains()) {
    const double value = valueOf(settings, gain), step = 1.001;
    LoopSettings more = settings, less = settings;
    setValue(more, gain, value * step);
    setValue(less, gain, value / step);
    const double slope = (computeWorstRate(more) - computeWorstRate(less)) / (2.0 * std::log(step));
    EXPECT_NEAR(computeMargin(settings, gain, false).slope, slope, 0.05 * std::abs(slope) + 0.01)
        << name(gain);
  }
}

}  // namespace
}  // namespace tandem
