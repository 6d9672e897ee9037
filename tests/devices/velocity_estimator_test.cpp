#include "falcon/src/guard/velocity_estimator.h"

#include <cmath>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "falcon/src/novint/falcon_kinematics.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kPi = 3.14159265358979323846;

template <typename Estimator>
class VelocityEstimator : public testing::Test {
 protected:
  static Estimator make() {
    if constexpr (std::is_same_v<Estimator, LowPassDifference>)
      return LowPassDifference(100.0);
    else
      return Estimator();
  }
};

class Names {
 public:
  template <typename Estimator>
  static std::string GetName(int) {
    if (std::is_same_v<Estimator, FirstDifference>) return "FirstDifference";
    return std::is_same_v<Estimator, LowPassDifference> ? "LowPassDifference" : "AdaptiveWindow";
  }
};

using Estimators = testing::Types<FirstDifference, LowPassDifference, AdaptiveWindow>;
TYPED_TEST_SUITE(VelocityEstimator, Estimators, Names);

TYPED_TEST(VelocityEstimator, IsZeroAtFirstAndExactOnALineAtUnevenTimes) {
  constexpr std::uint64_t kSeed = 5;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  TypeParam estimator = this->make();
  const Vec3 velocity(0.3, -20.0, 1500.0);
  EXPECT_EQ(estimator.add(7.0, 7.0 * velocity), Vec3::Zero());
  double time = 7.0;
  Vec3 estimate;
  for (int i = 0; i < 300; ++i) {
    time += random.uniform(0.2e-3, 3e-3);
    estimate = estimator.add(time, time * velocity);
  }
  EXPECT_LT((estimate - velocity).norm(), 1e-8 * velocity.norm());
}

TYPED_TEST(VelocityEstimator, LeavesOutWhatIsNoNewReading) {
  TypeParam estimator = this->make();
  for (int i = 0; i < 50; ++i) (void)estimator.add(i * kPeriod, Vec3(0.5 * i, 0, 0));
  TypeParam untouched = estimator;
  const double last = 49 * kPeriod, nan = std::nan("");
  const Vec3 before = untouched.add(last, Vec3::Zero());  // no later stamp: the last velocity again
  EXPECT_GT(before.x(), 100.0);
  for (const auto& [time, x] : {std::pair(last, 0.0),
                                {0.01, 3.0},
                                {nan, 3.0},
                                {1.0, nan},
                                {1.0, std::numeric_limits<double>::infinity()}})
    EXPECT_EQ(estimator.add(time, Vec3(x, 0, 0)), before);
  EXPECT_EQ(estimator.add(0.05, Vec3(25.0, 0, 0)), untouched.add(0.05, Vec3(25.0, 0, 0)));
}

TYPED_TEST(VelocityEstimator, KnowsNothingOfAJumpOnceItIsCleared) {
  TypeParam estimator = this->make(), fresh = this->make();
  for (int i = 0; i < 50; ++i) (void)estimator.add(i * kPeriod, Vec3(1.5 * i, -3.0 * i, 0));
  estimator.clear();
  for (int i = 50; i < 60; ++i) {
    const Vec3 p(4000.0 + 0.2 * i, 0, 0);
    EXPECT_EQ(estimator.add(i * kPeriod, p), fresh.add(i * kPeriod, p));
  }
}

TEST(FirstDifference, IsTheLastStepOverItsTime) {
  FirstDifference estimator;
  (void)estimator.add(0.0, Vec3(1, 2, 3));
  EXPECT_EQ(estimator.add(0.5, Vec3(2, 0, 3)), Vec3(2, -4, 0));
}

TEST(LowPassDifference, RisesToAStepOfVelocityExponentially) {
  constexpr double kCutoff = 30.0, kVelocity = 0.2;
  LowPassDifference estimator(kCutoff);
  (void)estimator.add(0.0, Vec3::Zero());
  for (int i = 1; i <= 40; ++i) {
    const double t = i * kPeriod;
    const double x = estimator.add(t, Vec3(kVelocity * t, 0, 0)).x();
    EXPECT_NEAR(x, kVelocity * (1.0 - std::exp(-2.0 * kPi * kCutoff * t)), 1e-12);
  }
}

/// Encoder counts of the motion `way` [counts].
template <typename Way>
Vec3 countAt(double t, const Way& way) {
  return {std::round(way(t)), 0.0, 0.0};
}

TEST(AdaptiveWindow, StandsStillOnOneCountAndTurnsOverInOneReading) {
  AdaptiveWindow estimator = makeUsualVelocityEstimator();
  for (int i = 0; i < 100; ++i)
    ASSERT_EQ(estimator.add(i * kPeriod, Vec3(17.0, 0, 0)), Vec3::Zero());
  // Five counts a period, away and back: the first reading contains none of the old window.
  EXPECT_NEAR(estimator.add(0.100, Vec3(22.0, 0, 0)).x(), 5000.0, 1e-6);
  EXPECT_NEAR(estimator.add(0.101, Vec3(17.0, 0, 0)).x(), -5000.0, 1e-6);
}

TEST(AdaptiveWindow, LooksBackNoFurtherThanAllowed) {
  for (const WindowFit fit : {WindowFit::kEnds, WindowFit::kBest}) {
    AdaptiveWindow estimator({0.7, 0.0, 8e-3, fit});
    for (int i = 0; i <= 20; ++i) (void)estimator.add(i * kPeriod, Vec3(0.01 * i * i, 0, 0));
    // On a parabola a bend within the tolerance allows 8 ms: the slope at its middle, 16 ms.
    EXPECT_NEAR(estimator.add(21 * kPeriod, Vec3(0.01 * 21 * 21, 0, 0)).x(),
                2 * 0.01 * 17 / kPeriod, 1e-9);
  }
}

TEST(AdaptiveWindow, LooksOverAGapNoFurtherThanToItsOtherEnd) {
  AdaptiveWindow estimator;
  for (int i = 0; i < 20; ++i) (void)estimator.add(i * kPeriod, Vec3(i, 0, 0));
  EXPECT_NEAR(estimator.add(1.019, Vec3(119.0, 0, 0)).x(), 100.0, 1e-9);
}

TEST(AdaptiveWindow, MissesNoReadingOfALongWindowWhateverItsRoom) {
  AdaptiveWindow estimator({1.0, 0.0, 10.0, WindowFit::kEnds});
  Vec3 estimate;
  for (int i = 0; i < 1000; ++i)
    estimate = estimator.add(i * kPeriod, countAt(i * kPeriod, [](double t) { return 130.0 * t; }));
  // The window has an error of one count over 63 periods.
  EXPECT_NEAR(estimate.x(), 130.0, 1.0 / 0.063);
}

// The promises of docs/devices.md for the usual estimator, with loose bounds. It is at least twice
// as calm as the difference, even with uneven stamps, and at most 4 ms late.
TEST(AdaptiveWindow, IsCalmerThanTheDifferenceAndNotMuchLater) {
  constexpr std::uint64_t kSeed = 6;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (const double speed : {40.0, 700.0, 2600.0}) {  // counts a second; 2.6 to 170 mm/s about
    AdaptiveWindow usual = makeUsualVelocityEstimator();
    FirstDifference difference;
    double usual_error = 0.0, difference_error = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const double taken = i * kPeriod + random.uniform(-0.2e-3, 0.2e-3);
      const Vec3 counts = countAt(taken, [&](double t) { return speed * t; });
      const double u = usual.add(i * kPeriod, counts).x() - speed;
      const double d = difference.add(i * kPeriod, counts).x() - speed;
      if (i < 100) continue;
      usual_error += u * u;
      difference_error += d * d;
    }
    EXPECT_LT(4.0 * usual_error, difference_error) << speed;
  }
  AdaptiveWindow usual = makeUsualVelocityEstimator();
  for (int i = 0; i < 400; ++i) {
    const double t = i * kPeriod;
    const auto way = [](double at) { return 100.0 * std::sin(2.0 * kPi * 3.0 * at); };
    const double x = usual.add(t, countAt(t, way)).x();
    if (i < 20) continue;
    const auto velocity = [](double at) { return 600.0 * kPi * std::cos(6.0 * kPi * at); };
    // The estimate lies between the velocities of the last 8 ms, apart from a count's noise.
    double least = velocity(t), most = least;
    for (double back = 0.0; back <= 8e-3; back += kPeriod) {
      least = std::min(least, velocity(t - back));
      most = std::max(most, velocity(t - back));
    }
    ASSERT_GT(x, least - 1000.0);
    ASSERT_LT(x, most + 1000.0);
  }
}

TEST(FalconVelocity, IsTheGripsWayOfTurningArms) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconKinematics kinematics;
  for (int i = 0; i < 200; ++i) {
    const Vec3 p_D = Vec3(0, 0, 0.125) + random.inCube(0.02), v_D = random.inCube(0.3);
    constexpr double h = 1e-6;
    const auto pose = kinematics.computePose(p_D);
    const auto before = kinematics.computeAngles(p_D - h * v_D);
    const auto after = kinematics.computeAngles(p_D + h * v_D);
    ASSERT_TRUE(pose && before && after);
    const Vec3 rates = (*after - *before) / (2.0 * h);
    const auto computed = computeVelocity(*pose, rates);
    ASSERT_TRUE(computed);
    EXPECT_LT((*computed - v_D).norm(), 1e-7);
    const Vec3 counts(countsOfAngle(rates[0]) - countsOfAngle(0), 0, 0);
    EXPECT_NEAR(angleRatesOfCounts(counts)[0], rates[0], 1e-9);
  }
  EXPECT_FALSE(computeVelocity(FalconPose(), Vec3(1, 0, 0)));
}

}  // namespace
}  // namespace tandem
