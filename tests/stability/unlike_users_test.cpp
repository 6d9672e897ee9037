// Users who differ are analysed together. Where they do not, that is what equal users have.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/coordination/stability_advice.h"

namespace tandem {
namespace {

LoopSettings makeLoop(StandInKind kind, int users) {
  LoopSettings settings;
  settings.stand_in = kind;
  settings.users = users;
  settings.object_mass = 0.1 * users;
  settings.mode = CoordinationMode::kAverage;
  return settings;
}

LoopSettings spellOut(LoopSettings settings) {
  settings.each.assign(static_cast<std::size_t>(settings.users), LoopUser());
  return settings;
}

TEST(UnlikeUsers, WhoAreAlikeHaveTheModesOfEqualUsers) {
  for (const StandInKind kind : {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic})
    for (const int users : {2, 3}) {
      const LoopSettings alike = makeLoop(kind, users);
      const auto worst = computeWorstGrowth(alike);
      const Growth all = computeGrowth(spellOut(alike), MotionMode::kAny);
      EXPECT_NEAR(all.rate, worst.growth.rate, 1e-9);
      EXPECT_NEAR(all.frequency, worst.growth.frequency, 1e-3 * worst.growth.frequency + 1e-3);
      EXPECT_NEAR(computeGrowthRate(spellOut(alike), MotionMode::kDeaf),
                  computeGrowthRate(alike, MotionMode::kDeaf), 1e-6);
      EXPECT_NEAR(computeDrag(spellOut(alike)), computeDrag(alike), 1e-6);
      if (users != 2) continue;
      ASSERT_EQ(all.shares.size(), 2u);
      EXPECT_NEAR(std::abs(all.shares[0]), std::abs(all.shares[1]), 1e-6);
      EXPECT_EQ(all.shares[0] * all.shares[1] > 0.0, worst.mode == MotionMode::kCommon);
    }
}

// What differs may be said in two ways.
TEST(UnlikeUsers, FactorsAndValuesAreOne) {
  LoopSettings twice = spellOut(makeLoop(StandInKind::kDynamic, 2));
  for (LoopUser& user : twice.each) {
    user.device_mass = 0.5;
    user.device_damping = 0.25;
    user.contact_stiffness = 2.0;
    user.contact_damping = 0.125;
    user.delays = {0.5, 0.5};
  }
  LoopSettings plain = makeLoop(StandInKind::kDynamic, 2);
  plain.device_mass *= 0.5;
  plain.device_damping *= 0.25;
  plain.contact = {2.0 * plain.contact.stiffness, 0.125 * plain.contact.damping};
  plain.delay *= 0.5;
  EXPECT_NEAR(computeWorstRate(twice), computeWorstRate(plain), 1e-9);
}

// The names of users do not matter.
TEST(UnlikeUsers, MayBeNumberedInAnyOrder) {
  LoopSettings settings = spellOut(makeLoop(StandInKind::kDynamic, 3));
  settings.each[0].device_mass = 0.5;
  settings.each[1].device_damping = 0.3;
  settings.each[2].contact_stiffness = 0.4;
  settings.each[0].delays = {1.0, 0.2, 0.6};
  settings.each[1].delays = {0.3, 1.0, 0.9};
  settings.each[2].delays = {0.7, 0.4, 1.0};
  LoopSettings turned = settings;
  const std::size_t order[] = {2, 0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    turned.each[i] = settings.each[order[i]];
    for (std::size_t k = 0; k < 3; ++k)
      turned.each[i].delays[k] = settings.each[order[i]].delays[order[k]];
  }
  const Growth before = computeGrowth(settings, MotionMode::kAny);
  const Growth after = computeGrowth(turned, MotionMode::kAny);
  EXPECT_NEAR(before.rate, after.rate, 1e-9);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(std::abs(after.shares[i]), std::abs(before.shares[order[i]]), 1e-6);
}

TEST(UnlikeUsers, HaveAdviceWhoseBordersAreBorders) {
  LoopSettings settings = spellOut(makeLoop(StandInKind::kNone, 2));
  settings.each[1].device_damping = 0.4;
  settings.each[1].delays = {0.5, 1.0};
  const GainMargin margin = computeMargin(settings, LoopGain::kCoordinationStiffness);
  ASSERT_TRUE(margin.above);
  LoopSettings there = settings;
  setValue(there, margin.gain, 1.001 * *margin.above);
  EXPECT_GT(computeWorstRate(there), 0.0);
  setValue(there, margin.gain, 0.999 * *margin.above);
  EXPECT_LT(computeWorstRate(there), 0.0);
}

TEST(UnlikeUsers, AreRefusedWhereTheyMakeNoSense) {
  const auto expectRefused = [](auto change) {
    LoopSettings settings = spellOut(makeLoop(StandInKind::kDynamic, 2));
    change(settings);
    EXPECT_THROW((void)computeWorstRate(settings), std::invalid_argument);
  };
  expectRefused([](LoopSettings& s) { s.each.resize(3); });
  expectRefused([](LoopSettings& s) { s.each[0].device_mass = 0.0; });
  expectRefused([](LoopSettings& s) { s.each[0].device_damping = -1.0; });
  expectRefused([](LoopSettings& s) { s.each[1].delays = {0.5}; });
  expectRefused([](LoopSettings& s) { s.each[1].delays = {1.5, 1.0}; });
  expectRefused([](LoopSettings& s) { s = spellOut(makeLoop(StandInKind::kDynamic, 5)); });
}

}  // namespace
}  // namespace tandem
