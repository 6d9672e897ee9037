// Private headers of coordination: both ways to move coupled degrees of freedom exactly.
#include "coordination/src/island/linear_series.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/linear_map.h"
#include "support/random.h"

namespace tandem {
namespace {

TEST(LinearSeries, IsTheLinearMap) {
  constexpr double kPeriod = 1e-3;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const auto n = static_cast<std::size_t>(1 + random.below(3));
    const auto size = static_cast<Eigen::Index>(n);
    LinearSeries series(n);
    Eigen::VectorXd mass(size);
    Eigen::MatrixXd damping = Eigen::MatrixXd::Zero(size, size), stiffness = damping;
    for (std::size_t i = 0; i < n; ++i) {
      const auto place = static_cast<Eigen::Index>(i);
      mass(place) = random.logUniform(0.02, 2.0);
      series.setInverseMass(i, 1.0 / mass(place));
      const double k = random.logUniform(1.0, 1e5), b = random.logUniform(0.01, 300.0);
      series.tie(i, k, b);
      stiffness(place, place) += k, damping(place, place) += b;
      if (i == 0) continue;
      series.tie(i - 1, i, 2.0 * k, 0.5 * b);
      const Eigen::Vector2d pair(1.0, -1.0);
      stiffness.block<2, 2>(place - 1, place - 1) += 2.0 * k * pair * pair.transpose();
      damping.block<2, 2>(place - 1, place - 1) += 0.5 * b * pair * pair.transpose();
    }
    const LinearMap map(kPeriod, mass, damping, stiffness);
    std::vector<double> state(2 * n), u(n), w(n), by_map(2 * n), by_series(2 * n);
    for (std::size_t i = 0; i < n; ++i) {
      state[i] = random.uniform(-1e-3, 1e-3), state[n + i] = random.uniform(-0.1, 0.1);
      u[i] = random.uniform(-5, 5), w[i] = random.uniform(-100, 100);
    }
    for (const int level : {0, 1, 5, 20, 31}) {
      map.step(level, state.data(), u.data(), w.data(), by_map.data());
      series.step(std::ldexp(kPeriod, -level), state.data(), u.data(), w.data(), by_series.data());
      // Rounding of the map's exponential dominates; its norm contains K / m.
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(by_series[i], by_map[i], 1e-12) << level;
        EXPECT_NEAR(by_series[n + i], by_map[n + i], 1e-9) << level;
      }
    }
    // Two half steps equal one full step, to the rounding of a double.
    std::vector<double> half(2 * n), halves(2 * n), later(n);
    for (std::size_t i = 0; i < n; ++i) later[i] = u[i] + 0.5 * kPeriod * w[i];
    series.step(kPeriod, state.data(), u.data(), w.data(), by_series.data());
    series.step(0.5 * kPeriod, state.data(), u.data(), w.data(), half.data());
    series.step(0.5 * kPeriod, half.data(), later.data(), w.data(), halves.data());
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(by_series[i], halves[i], 1e-17);
      EXPECT_NEAR(by_series[n + i], halves[n + i], 1e-14);
    }
  }
}

TEST(LinearSeries, HoldsWhatHasNoMass) {
  LinearSeries series(2);
  series.setInverseMass(1, 10.0);
  series.tie(1, 100.0, 1.0);
  const double state[] = {0.3, 0.01, 0.0, 0.1}, u[] = {5.0, 1.0}, w[] = {1.0, 0.0};
  double next[4];
  series.step(1e-3, state, u, w, next);
  EXPECT_EQ(next[0], 0.3);
  EXPECT_EQ(next[2], 0.0);
  EXPECT_NE(next[1], 0.01);
}

TEST(LinearSeries, StiffDampersDecay) {
  LinearSeries series(1);
  series.setInverseMass(0, 10.0);
  series.tie(0, 0.0, 1e4);  // 10 us
  const double state[] = {0.0, 1.0}, u[] = {0.0}, w[] = {0.0};
  double next[2];
  series.step(1e-3, state, u, w, next);
  EXPECT_NEAR(next[0], 1e-5, 1e-16);
  EXPECT_NEAR(next[1], std::exp(-100.0), 1e-40);
}

}  // namespace
}  // namespace tandem
