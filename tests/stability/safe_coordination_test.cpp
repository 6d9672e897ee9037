// Gains that are chosen for a delay are what the document says of them.
#include "tandem/coordination/safe_coordination.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

#include "support/random.h"

namespace tandem {
namespace {

double rateOf(LoopSettings settings, const CouplerGains& gains, double later = 0.0) {
  settings.coordination = gains;
  settings.delay = std::max(0.0, settings.delay + later);
  return computeWorstRate(settings);
}

void expectSafe(const LoopSettings& settings, const CouplerGains& gains) {
  const auto& [K, B] = gains;
  const double half = 0.5 / settings.packet_rate;
  EXPECT_LT(rateOf(settings, gains), -1.0 / (50.0 * std::max(settings.delay + half, 0.02)));
  EXPECT_LT(rateOf(settings, {2.0 * K, B}), 0.0);
  EXPECT_LT(rateOf(settings, {K, 1.5 * B}), 0.0);
  EXPECT_LT(rateOf(settings, {K, B / 1.5}), 0.0);
  EXPECT_LT(rateOf(settings, gains, half), 0.0);
  EXPECT_LT(rateOf(settings, gains, -half), 0.0);
}

void expectTwoDigits(double value) {
  const double digits = value / std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  EXPECT_NEAR(digits, std::round(digits), 1e-9) << value;
}

TEST(SafeCoordination, HasTheMarginsThatItPromises) {
  constexpr std::uint64_t kSeed = 2009;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  int for_empty_hands = 0;
  for (int i = 0; i < 8; ++i) {
    LoopSettings settings;
    settings.stand_in = i % 2 == 0 ? StandInKind::kNone : StandInKind::kDynamic;
    settings.users = i % 4 == 3 ? 3 : 2;
    settings.mode = i % 4 == 3 ? CoordinationMode::kAverage : CoordinationMode::kSum;
    settings.delay = random.uniform(0.0, 0.1);
    settings.device_damping = random.uniform(0.3, 6.0);
    settings.contact.stiffness = random.uniform(500.0, 4000.0);
    SCOPED_TRACE(i);
    const SafeCoordination chosen = chooseCoordination(settings);
    expectTwoDigits(chosen.gains.stiffness);
    expectTwoDigits(chosen.gains.damping);
    EXPECT_EQ(chosen.rate, rateOf(settings, chosen.gains));
    for_empty_hands += chosen.is_for_empty_hands;
    if (chosen.is_for_empty_hands) expectSafe(settings, chosen.gains);
  }
  EXPECT_GE(for_empty_hands, 6);
}

TEST(SafeCoordination, IsSofterTheLongerTheDelay) {
  for (const bool has_object : {true, false}) {
    double last = HUGE_VAL;
    for (const double delay : {0.0, 0.05, 0.1}) {
      LoopSettings settings;
      settings.has_object = has_object;
      if (!has_object) settings.contact.stiffness = 2000.0;
      settings.delay = delay;
      const SafeCoordination chosen = chooseCoordination(settings);
      EXPECT_TRUE(chosen.is_for_empty_hands) << delay;
      EXPECT_LT(chosen.gains.stiffness, last) << delay;
      last = chosen.gains.stiffness;
    }
  }
}

TEST(SafeCoordination, KeepsWhatIsGiven) {
  LoopSettings settings;
  settings.stand_in = StandInKind::kNone;
  const SafeCoordination soft = chooseCoordination(settings, {60.0, std::nullopt});
  EXPECT_EQ(soft.gains.stiffness, 60.0);
  expectSafe(settings, soft.gains);
  const SafeCoordination damped = chooseCoordination(settings, {std::nullopt, 15.0});
  EXPECT_EQ(damped.gains.damping, 15.0);
  expectSafe(settings, damped.gains);
}

// Nothing calms a wall of 4000 N/m that a device of 0.5 N s/m touches, but a hand does not need to.
TEST(SafeCoordination, TellsWhereNoneIs) {
  LoopSettings settings;
  settings.stand_in = StandInKind::kHeld;
  const SafeCoordination chosen = chooseCoordination(settings);
  EXPECT_FALSE(chosen.is_for_empty_hands);
  EXPECT_GT(chosen.rate, 0.0);
  EXPECT_THROW((void)chooseCoordination([] {
                 LoopSettings bad;
                 bad.delay = -1.0;
                 return bad;
               }()),
               std::invalid_argument);
}

}  // namespace
}  // namespace tandem
