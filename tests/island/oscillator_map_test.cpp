// Private header of coordination: the map that moves a body with couplers only.
#include "coordination/src/island/oscillator_map.h"

#include <cmath>

#include <gtest/gtest.h>

namespace tandem {
namespace {

/// Displacement S after a unit push, x'' + c x' + k x = 0, in extended precision.
long double computeWay(long double k, long double c, long double h) {
  const long double d = c / 2, square = d * d - k;
  if (square == 0) return std::exp(-d * h) * h;
  if (square < 0) {
    const long double w = std::sqrt(-square);
    return std::exp(-d * h) * std::sin(w * h) / w;
  }
  const long double w = std::sqrt(square);
  return -std::exp(-k / (d + w) * h) * std::expm1(-2 * w * h) / (2 * w);
}

struct Gains {
  double stiffness, damping;  // per mass [1/s^2, 1/s]
};

class OscillatorMapOf : public ::testing::TestWithParam<Gains> {};

TEST_P(OscillatorMapOf, IsTheClosedForm) {
  const auto [k, c] = GetParam();
  for (const double h : {1e-3, 0.37e-3, 1e-6, 4e-3}) {
    const OscillatorMap map = computeOscillatorMap(k, c, h);
    const double way = static_cast<double>(computeWay(k, c, h));
    // Rounding of a few doublings, relative to the longest possible way.
    EXPECT_NEAR(map.velocity_to_way, way, 4e-15 * h) << "h = " << h;
    // x'' + c x' + k x = 1 from rest, integrated once: v + c x + k * integral of x = t.
    EXPECT_NEAR(map.velocity_to_velocity + c * map.velocity_to_way + k * map.acceleration_to_way,
                1.0, 1e-14 * (1.0 + c * h))
        << "h = " << h;
  }
}

INSTANTIATE_TEST_SUITE_P(Gains, OscillatorMapOf,
                         ::testing::Values(Gains{0, 0}, Gains{4e4, 0}, Gains{2e4, 100},
                                           Gains{1e4, 200},  // critical
                                           Gains{2e3, 300}, Gains{1e-3, 0}, Gains{0, 1e-3},
                                           Gains{0, 1e5}, Gains{1e9, 1e4}, Gains{1e4, 1e6},
                                           Gains{1e9, 1e6}));

TEST(OscillatorMap, StaysFiniteAtAbsurdGains) {
  for (const double k : {0.0, 1e3, 1e12, 1e20})
    for (const double c : {0.0, 1e3, 1e9, 1e15}) {
      const OscillatorMap map = computeOscillatorMap(k, c, 1e-3);
      EXPECT_LE(std::abs(map.velocity_to_way), 1.001e-3) << k << ' ' << c;
      EXPECT_LE(std::abs(map.velocity_to_velocity), 1.001) << k << ' ' << c;
      EXPECT_LE(std::abs(map.acceleration_to_way), 1e-6) << k << ' ' << c;
    }
}

TEST(OscillatorMap, OfNoTimeIsNothing) {
  const OscillatorMap map = computeOscillatorMap(1e4, 10.0, 0.0);
  EXPECT_EQ(map.velocity_to_way, 0.0);
  EXPECT_EQ(map.acceleration_to_way, 0.0);
  EXPECT_EQ(map.velocity_to_velocity, 1.0);
}

}  // namespace
}  // namespace tandem
