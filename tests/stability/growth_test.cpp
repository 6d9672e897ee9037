// How small motions grow: closed forms, and values that runs of the simulator have confirmed.
#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tandem/coordination/stability.h"

#include "coordination/src/stability/monodromy.h"
#include "stability/papers_loops.h"

namespace tandem {
namespace {

using test::makeFirstExperiment;
using test::makeSecondExperiment;

double rateOf(const LoopSettings& settings, MotionMode mode) {
  return computeGrowthRate(settings, mode);
}

struct Row {
  const char* name;
  LoopSettings settings;
  double common, difference;
};

TEST(Growth, PapersRowsAreThoseThatRunsConfirmed) {
  const Row rows[] = {
      {"I virtual coupling", makeFirstExperiment(StandInKind::kNone), -2.43, -0.583},
      {"I kinematic", makeFirstExperiment(StandInKind::kHeld), 8.05, 7.24},
      {"I dynamic", makeFirstExperiment(StandInKind::kDynamic), 1.08, 1.91},
      {"II kinematic", makeSecondExperiment(StandInKind::kHeld), 10.52, 13.69},
      {"II dynamic", makeSecondExperiment(StandInKind::kDynamic), -0.28, 1.46},
  };
  for (const Row& row : rows) {
    EXPECT_NEAR(rateOf(row.settings, MotionMode::kCommon), row.common, 0.006) << row.name;
    EXPECT_NEAR(rateOf(row.settings, MotionMode::kDifference), row.difference, 0.006) << row.name;
  }
  EXPECT_NEAR(
      computeGrowth(makeFirstExperiment(StandInKind::kDynamic), MotionMode::kDifference).frequency,
      23.8, 0.05);
  EXPECT_NEAR(
      computeGrowth(makeSecondExperiment(StandInKind::kDynamic), MotionMode::kDifference).frequency,
      4.1, 0.05);
}

// Runs of 50 to 200 s have these boundaries, within 0.01 %.
TEST(Growth, IsZeroAtTheBoundariesOfRuns) {
  const auto expectBoundary = [](LoopSettings settings, auto member, double at, MotionMode mode) {
    member(settings) = (1.0 - 2e-4) * at;
    const double below = rateOf(settings, mode);
    member(settings) = (1.0 + 2e-4) * at;
    EXPECT_LT(below * rateOf(settings, mode), 0.0) << at;
  };
  const auto K_t = [](LoopSettings& s) -> double& { return s.coordination.stiffness; };
  const auto B_t = [](LoopSettings& s) -> double& { return s.coordination.damping; };
  const auto K_vc = [](LoopSettings& s) -> double& { return s.contact.stiffness; };
  const auto B_vc = [](LoopSettings& s) -> double& { return s.contact.damping; };
  const auto b_dev = [](LoopSettings& s) -> double& { return s.device_damping; };
  const auto delay = [](LoopSettings& s) -> double& { return s.delay; };
  constexpr auto kDifference = MotionMode::kDifference;
  const LoopSettings coupled = makeFirstExperiment(StandInKind::kNone);
  expectBoundary(coupled, K_t, 389.451, kDifference);
  expectBoundary(coupled, B_t, 8.41134, kDifference);
  expectBoundary(coupled, B_t, 38.4306, kDifference);
  expectBoundary(coupled, delay, 0.0849262, kDifference);
  expectBoundary(coupled, K_vc, 4423.77, kDifference);
  expectBoundary(coupled, B_vc, 0.605915, kDifference);
  const LoopSettings dynamic = makeFirstExperiment(StandInKind::kDynamic);
  expectBoundary(dynamic, K_vc, 390.671, kDifference);
  expectBoundary(dynamic, b_dev, 2.36404, kDifference);
  const LoopSettings touched = makeSecondExperiment(StandInKind::kDynamic);
  expectBoundary(touched, K_t, 73.9438, kDifference);
  expectBoundary(touched, b_dev, 2.67771, kDifference);
  expectBoundary(touched, K_vc, 20.4861, kDifference);
  LoopSettings held = makeFirstExperiment(StandInKind::kNone);
  held.hand = {0.0, 300.0, 5.0};
  expectBoundary(held, K_t, 2101.17, kDifference);
}

// A wall: one tick leads (x, v) by a matrix of two rows.
TEST(Growth, OfAHandAtAWallIsThatOfItsTwoRows) {
  for (const double K : {500.0, 2000.0, 4000.0}) {
    LoopSettings wall = makeSecondExperiment(StandInKind::kHeld);
    wall.contact.stiffness = K;
    const double T = 1e-3, m = wall.device_mass, b = wall.device_damping, B = wall.contact.damping;
    const double a = b * T / m, p1 = (1.0 - std::exp(-a)) / a, p2 = (1.0 - p1) / a;
    Eigen::Matrix2d step;
    step << 1.0 - K * T * T * p2 / m, T * p1 - B * T * T * p2 / m,  //
        -K * T * p1 / m, std::exp(-a) - B * T * p1 / m;
    const double rate = std::log(step.eigenvalues().cwiseAbs().maxCoeff()) / T;
    EXPECT_NEAR(rateOf(wall, MotionMode::kDeaf), rate, 1e-9 * std::abs(rate) + 1e-9) << K;
  }
}

// The hold alone gives energy: rho - 1 = K T^2 / (4 m) for each tick.
TEST(Growth, OfTheHoldAloneIsASmallShareOfTheSpring) {
  LoopSettings hold = makeFirstExperiment(StandInKind::kNone);
  hold.coordination = {0.0, 0.0};
  hold.contact.damping = hold.device_damping = 0.0;
  hold.packet_rate = hold.haptic_rate;
  hold.delay = 0.0;
  for (const auto& [K, rise] :
       {std::pair{1.0, 2.5e-6}, {100.0, 2.5001e-4}, {1000.0, 2.501e-3}, {4000.0, 1.0016e-2}}) {
    hold.contact.stiffness = K;
    const double per_tick = std::exp(rateOf(hold, MotionMode::kDeaf) * 1e-3) - 1.0;
    EXPECT_NEAR(per_tick, rise, 1e-4 * rise) << K;
  }
}

TEST(Growth, MovingEverythingAlongMeetsNoForce) {
  for (const StandInKind kind : {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic}) {
    const stability::Monodromy loop(
        stability::makeModeModel(makeFirstExperiment(kind), MotionMode::kCommon));
    const Eigen::VectorXd shift = loop.makeShift();
    EXPECT_LT((loop.makeMatrix() * shift - shift).norm(), 1e-10 * shift.norm());
  }
}

/// The largest multipliers of all users by themselves, with nothing left out.
std::vector<double> listSizes(const stability::Monodromy& loop) {
  const Eigen::VectorXd sizes = loop.makeMatrix().eigenvalues().cwiseAbs();
  std::vector<double> all(sizes.data(), sizes.data() + sizes.size());
  std::sort(all.rbegin(), all.rend());
  return all;
}

// N equal users are one common mode and N - 1 times that of differences.
TEST(Growth, OfEqualUsersIsThatOfOneWhoHearsHimself) {
  for (const int users : {2, 3, 4}) {
    for (const CoordinationMode mode : {CoordinationMode::kSum, CoordinationMode::kAverage}) {
      LoopSettings settings = makeFirstExperiment(StandInKind::kDynamic);
      settings.users = users;
      settings.mode = mode;
      settings.hand = {0.0, 300.0, 5.0};  // no multiplier is 1
      settings.delay = 0.02;
      const std::vector<double> full = listSizes(stability::Monodromy(
          stability::makeFullModel(settings, std::vector<double>(users, 0.0))));
      const auto common =
          listSizes(stability::Monodromy(stability::makeModeModel(settings, MotionMode::kCommon)));
      std::vector<double> reduced = common;
      const auto difference = listSizes(
          stability::Monodromy(stability::makeModeModel(settings, MotionMode::kDifference)));
      for (int i = 1; i < users; ++i)
        reduced.insert(reduced.end(), difference.begin(), difference.end());
      std::sort(reduced.rbegin(), reduced.rend());
      ASSERT_EQ(full.size(), reduced.size());
      for (std::size_t i = 0; i < 8; ++i) EXPECT_NEAR(full[i], reduced[i], 1e-9) << users;
    }
  }
}

// What one site's packets lag behind another's matters for some gains and not for others.
TEST(Growth, DependsOnThePhaseOfPackets) {
  const auto findRange = [](const LoopSettings& settings) {
    std::pair<double, double> range{HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 8; ++i) {
      const double rate = computeRateAtPhase(settings, i / 8.0);
      range = {std::min(range.first, rate), std::max(range.second, rate)};
    }
    return range;
  };
  const LoopSettings coupled = makeFirstExperiment(StandInKind::kNone);
  const double in_phase =
      std::max(rateOf(coupled, MotionMode::kCommon), rateOf(coupled, MotionMode::kDifference));
  EXPECT_NEAR(computeRateAtPhase(coupled, 0.0), in_phase, 1e-8);
  EXPECT_NEAR(computeRateAtPhase(coupled, 1.0), in_phase, 1e-8);
  const auto [least, most] = findRange(coupled);
  EXPECT_NEAR(least, -0.678, 2e-3);
  EXPECT_NEAR(most, -0.517, 2e-3);
  const auto [least_dynamic, most_dynamic] = findRange(makeFirstExperiment(StandInKind::kDynamic));
  EXPECT_NEAR(least_dynamic, 1.91, 0.01);
  EXPECT_NEAR(most_dynamic, 2.62, 0.01);
}

// By average alone, whole proxies make three users unstable; proxies of 1/(N-1) do not.
TEST(Growth, ThreeAveragedUsersNeedProxiesOfHalfAUser) {
  LoopSettings three = makeFirstExperiment(StandInKind::kDynamic);
  three.users = 3;
  three.object_mass = 0.3;
  three.mode = CoordinationMode::kAverage;
  three.delay = 0.02;
  three.hand = {0.0, 300.0, 5.0};
  const auto worst = [&] {
    return std::max(rateOf(three, MotionMode::kCommon), rateOf(three, MotionMode::kDifference));
  };
  EXPECT_NEAR(worst(), -5.5, 0.06);
  three.stand_in_share = 1.0;
  EXPECT_NEAR(worst(), 3.2, 0.06);
  three.stand_in = StandInKind::kNone;
  EXPECT_NEAR(worst(), -7.5, 0.06);
}

// Rule: b_dev + n w K_t tau, with the age tau of what a site knows; right to 1 %, as the ripple of
// packets goes through the damper.
TEST(Drag, OfCommonMotionIsThatOfTheDelay) {
  LoopSettings settings = makeFirstExperiment(StandInKind::kNone);
  EXPECT_NEAR(computeDrag(settings), 11.193, 1e-3);
  settings.users = 8;
  EXPECT_NEAR(computeDrag(settings), 76.96, 0.01);
  settings.mode = CoordinationMode::kAverage;
  EXPECT_NEAR(computeDrag(settings), 9.965, 1e-3);
  EXPECT_NEAR(computeDrag(makeFirstExperiment(StandInKind::kDynamic)), 20.5, 0.05);
  EXPECT_NEAR(computeDrag(makeSecondExperiment(StandInKind::kHeld)), 208.4, 0.05);
}

TEST(Growth, TakesARateWithoutAPeriodAsTheNextOne) {
  LoopSettings settings;
  for (const double rate : {128.0, 60.0, 128.123456, 127.3219, 99.0 * std::sqrt(2.0), 1000.0}) {
    settings.packet_rate = rate;
    EXPECT_NEAR(findAnalysedPacketRate(settings), rate, 1e-4 * rate);
  }
  // Neighbours in between have nearly the same growth.
  settings.packet_rate = 128.0;
  const double at_128 = rateOf(settings, MotionMode::kDifference);
  settings.packet_rate = 128.003;
  EXPECT_NEAR(rateOf(settings, MotionMode::kDifference), at_128, 0.5);
}

TEST(Growth, RefusesWhatItCannotAnalyse) {
  LoopSettings settings;
  settings.delay = 0.6;
  EXPECT_THROW((void)rateOf(settings, MotionMode::kCommon), std::invalid_argument);
  settings = {};
  settings.packet_rate = 0.3;
  EXPECT_THROW((void)rateOf(settings, MotionMode::kCommon), std::invalid_argument);
  settings = {};
  settings.users = 1;
  EXPECT_THROW((void)rateOf(settings, MotionMode::kCommon), std::invalid_argument);
  settings = makeSecondExperiment(StandInKind::kNone);
  EXPECT_THROW((void)rateOf(settings, MotionMode::kCommon), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
