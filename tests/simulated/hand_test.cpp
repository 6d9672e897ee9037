#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tandem/falcon/simulated_device.h"

namespace tandem {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Text of the std::invalid_argument that `make` throws, empty if it throws none.
template <typename Make>
std::string refusal(Make make) {
  try {
    (void)make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ConstantHand, GivesTheSameForceAtAnyTimeAndPlace) {
  const Vec3 f(5.0, -1.0, 0.25);
  const auto hand = makeConstantHand(f);
  EXPECT_EQ(hand->computeForce(0.0, {}), f);
  EXPECT_EQ(hand->computeForce(7.3, {Vec3(1, 2, 3), Vec3(4, 5, 6)}), f);
}

TEST(ConstantHand, RefusesForceThatIsNotFinite) {
  const std::string text = refusal([] { return makeConstantHand(Vec3(1.5, kNan, 0.0)); });
  EXPECT_NE(text.find("[1.5, nan, 0]"), std::string::npos) << text;
}

TEST(SineHand, StartsAtItsPhaseAndPeaksAQuarterPeriodLater) {
  const Vec3 f(2.0, 0.0, -4.0);
  const double frequency = 2.5;  // [Hz]
  const auto hand = makeSineHand(f, frequency, 0.0);
  // sin is off by the rounding of its argument, which is below 2 pi here.
  const double tolerance = 4.0 * 8.0 * kEps;
  EXPECT_EQ(hand->computeForce(0.0, {}), Vec3::Zero());
  EXPECT_LT((hand->computeForce(0.25 / frequency, {}) - f).norm(), tolerance);
  EXPECT_LT(hand->computeForce(0.5 / frequency, {}).norm(), tolerance);
  EXPECT_LT((hand->computeForce(0.75 / frequency, {}) + f).norm(), tolerance);

  const double phase = 0.7;  // [rad]
  const auto shifted = makeSineHand(f, frequency, phase);
  EXPECT_LT((shifted->computeForce(0.0, {}) - f * std::sin(phase)).norm(), tolerance);
}

TEST(SineHand, RefusesBadValuesByName) {
  const Vec3 f(1, 0, 0);
  const std::string frequency = refusal([&] { return makeSineHand(f, -2.0, 0.0); });
  EXPECT_NE(frequency.find("frequency"), std::string::npos) << frequency;
  EXPECT_NE(frequency.find("is -2,"), std::string::npos) << frequency;
  EXPECT_NE(refusal([&] { return makeSineHand(f, kInfinity, 0.0); }).find("frequency"),
            std::string::npos);
  EXPECT_NE(refusal([&] { return makeSineHand(f, 1.0, kNan); }).find("phase"), std::string::npos);
  EXPECT_NE(refusal([&] { return makeSineHand(f * kInfinity, 1.0, 0.0); }).find("force"),
            std::string::npos);
}

/// One stroke, read through the hand's force with the handle at rest in the origin. Gains (1, 0)
/// give the reference position, gains (0, 1) the reference velocity.
class MinimumJerkHandTest : public ::testing::Test {
 protected:
  Vec3 position(double t) const { return as_position_->computeForce(t, {}); }
  Vec3 velocity(double t) const { return as_velocity_->computeForce(t, {}); }

  const Waypoint from_{0.5, Vec3(0.1, -0.2, 0.0)};
  const Waypoint to_{2.5, Vec3(0.4, 0.2, 1.2)};
  const Vec3 way_ = to_.p_W - from_.p_W;     // length 1.3 m
  const double duration_ = to_.t - from_.t;  // [s]
  const std::unique_ptr<Hand> as_position_ = makeMinimumJerkHand({from_, to_}, 1.0, 0.0);
  const std::unique_ptr<Hand> as_velocity_ = makeMinimumJerkHand({from_, to_}, 0.0, 1.0);
};

TEST_F(MinimumJerkHandTest, RestsOnTheWaypointsOutsideTheStroke) {
  for (const double t : {-1.0, 0.0, 0.5}) {
    EXPECT_EQ(position(t), from_.p_W) << t;
    EXPECT_EQ(velocity(t), Vec3::Zero()) << t;
  }
  for (const double t : {2.5, 3.0, 1e9}) {
    EXPECT_EQ(position(t), to_.p_W) << t;
    EXPECT_EQ(velocity(t), Vec3::Zero()) << t;
  }
  // Just before its end the stroke must be where the rest begins. The remainder is cubic in the
  // time left, 1e-18. Rounding adds that of a polynomial with terms up to 15 over 1.3 m.
  EXPECT_LT((position(2.5 - 1e-6) - to_.p_W).norm(), 15.0 * 1.3 * kEps);
}

TEST_F(MinimumJerkHandTest, IsHalfWayAtHalfTimeWithPeakVelocity) {
  const double middle = 0.5 * (from_.t + to_.t);
  EXPECT_LT((position(middle) - 0.5 * (from_.p_W + to_.p_W)).norm(), 4.0 * kEps);
  EXPECT_LT((velocity(middle) - 1.875 * way_ / duration_).norm(), 8.0 * kEps);
  for (int i = 0; i <= 1000; ++i) {
    const double t = from_.t + duration_ * i / 1000.0;
    EXPECT_LE(velocity(t).norm(), 1.875 * way_.norm() / duration_ * (1.0 + 8.0 * kEps)) << t;
  }
}

TEST_F(MinimumJerkHandTest, VelocityIsSymmetricAndPositionPointSymmetric) {
  for (int i = 1; i < 50; ++i) {
    const double s = duration_ * i / 100.0;
    EXPECT_LT((velocity(from_.t + s) - velocity(to_.t - s)).norm(), 32.0 * kEps) << s;
    EXPECT_LT((position(from_.t + s) + position(to_.t - s) - from_.p_W - to_.p_W).norm(),
              32.0 * kEps)
        << s;
  }
}

TEST_F(MinimumJerkHandTest, VelocityIsTheDerivativeOfThePosition) {
  const double h = 1e-4;  // [s]
  // The central difference is off by h^2/6 times the third derivative, plus rounding eps / h. The
  // derivative is at most 60 d/T^3, at the ends.
  const double tolerance =
      h * h / 6.0 * 60.0 * way_.norm() / std::pow(duration_, 3) + 10 * kEps / h;
  for (int i = 1; i < 20; ++i) {
    const double t = from_.t + duration_ * i / 20.0;
    const Vec3 difference = (position(t + h) - position(t - h)) / (2.0 * h);
    EXPECT_LT((velocity(t) - difference).norm(), tolerance) << t;
  }
}

TEST_F(MinimumJerkHandTest, HoldsTheHandleByASpringDamper) {
  const double K = 300.0;  // [N/m]
  const double B = 4.0;    // [N s/m]
  const auto hand = makeMinimumJerkHand({from_, to_}, K, B);
  const PointState handle{Vec3(0.2, 0.0, 0.5), Vec3(-0.1, 0.3, 0.0)};
  const double t = 1.1;
  const Vec3 expected = K * (position(t) - handle.p_W) + B * (velocity(t) - handle.v_W);
  EXPECT_LT((hand->computeForce(t, handle) - expected).norm(), 1e-12);  // 500 N, 10 roundings
}

TEST(MinimumJerkHand, RunsThroughSeveralWaypointsAndHoldsASingleOne) {
  const auto path = makeMinimumJerkHand(
      {{0.0, Vec3::Zero()}, {1.0, Vec3(1, 0, 0)}, {3.0, Vec3(1, 2, 0)}}, 1.0, 0.0);
  EXPECT_EQ(path->computeForce(1.0, {}), Vec3(1, 0, 0));
  EXPECT_EQ(path->computeForce(2.0, {}), Vec3(1, 1, 0));
  EXPECT_EQ(path->computeForce(4.0, {}), Vec3(1, 2, 0));

  const auto still = makeMinimumJerkHand({{1.0, Vec3(0, 0, 3)}}, 1.0, 0.0);
  for (const double t : {0.0, 1.0, 2.0}) EXPECT_EQ(still->computeForce(t, {}), Vec3(0, 0, 3)) << t;
}

TEST(MinimumJerkHand, RefusesBadValuesByName) {
  const auto text = [](std::vector<Waypoint> waypoints, double stiffness, double damping) {
    return refusal([&] { return makeMinimumJerkHand(waypoints, stiffness, damping); });
  };
  const Vec3 p(0, 0, 0);
  struct Case {
    std::string refusal;
    std::string name;
    std::string value;
  };
  const Case cases[] = {
      {text({}, 1, 1), "0 waypoints", "1 or more"},
      {text({{0.0, p}, {2.0, p}, {2.0, p}}, 1, 1), "waypoint 2", "time is 2,"},
      {text({{0.0, p}, {-1.5, p}}, 1, 1), "waypoint 1", "time is -1.5,"},
      {text({{kNan, p}}, 1, 1), "waypoint 0", "time is nan,"},
      {text({{-1.7e308, p}, {1.7e308, p}}, 1, 1), "waypoint 1", "time is 1.7e+308,"},
      {text({{0.0, Vec3(0, kInfinity, 0)}}, 1, 1), "waypoint 0", "position is [0, inf, 0],"},
      {text({{0.0, p}}, -3, 1), "stiffness", "is -3,"},
      {text({{0.0, p}}, kNan, 1), "stiffness", "is nan,"},
      {text({{0.0, p}}, 1, -0.5), "damping", "is -0.5,"},
      {text({{0.0, p}}, 1, kInfinity), "damping", "is inf,"},
  };
  for (const Case& c : cases) {
    EXPECT_NE(c.refusal.find(c.name), std::string::npos) << c.name << " in: " << c.refusal;
    EXPECT_NE(c.refusal.find(c.value), std::string::npos) << c.value << " in: " << c.refusal;
  }
}

}  // namespace
}  // namespace tandem
