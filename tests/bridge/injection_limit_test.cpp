#include <cmath>
#include <complex>
#include <limits>

#include <gtest/gtest.h>

#include "bullet_bridge/src/bodies/haptic_body.h"
#include "support/random.h"

namespace tandem {
namespace {

/// Largest eigenvalue of one step of v += dt (-K x - B v) / m; x += dt v. Uses trace and
/// determinant.
double computeSpectralRadius(double K, double B, double m, double dt) {
  const double trace = 2.0 - dt * B / m - dt * dt * K / m;
  const double determinant = 1.0 - dt * B / m;
  const std::complex<double> root =
      std::sqrt(std::complex<double>(trace * trace / 4 - determinant));
  return std::max(std::abs(trace / 2 + root), std::abs(trace / 2 - root));
}

// Eigenvalues on the unit circle are 1 up to the rounding of a square root.
constexpr double kUnit = 1.0 + 1e-7;

TEST(InjectionStepLimit, IsWhereTheStepMapLeavesTheUnitCircle) {
  constexpr std::uint64_t kSeed = 20090121;
  RecordProperty("seed", std::to_string(kSeed));
  test::Random random(kSeed);
  const auto uniform = [&] { return random.uniform(0.0, 1.0); };
  for (int i = 0; i < 2000; ++i) {
    const double K = std::pow(10.0, 5.0 * uniform());         // [N/m]
    const double B = std::pow(10.0, -2.0 + 4.0 * uniform());  // [N s/m]
    const double m = std::pow(10.0, -2.0 + 2.0 * uniform());  // [kg]
    const double limit = computeInjectionStepLimit(K, B, m);
    EXPECT_LE(computeSpectralRadius(K, B, m, 0.999 * limit), kUnit)
        << "K " << K << " B " << B << " m " << m;
    EXPECT_GT(computeSpectralRadius(K, B, m, 1.001 * limit), 1.0)
        << "K " << K << " B " << B << " m " << m;
  }
}

TEST(InjectionStepLimit, KnowsTheLimitsOfItsFormula) {
  EXPECT_EQ(computeInjectionStepLimit(0, 0, 0.1), std::numeric_limits<double>::infinity());
  EXPECT_DOUBLE_EQ(computeInjectionStepLimit(0, 10, 0.1), 2 * 0.1 / 10);
  EXPECT_DOUBLE_EQ(computeInjectionStepLimit(2000, 0, 0.1), 2 / std::sqrt(2000 / 0.1));
  // w = sqrt(2000 / 0.1), z = 10 / (2 0.1 w)
  EXPECT_NEAR(computeInjectionStepLimit(2000, 10, 0.1), 0.0100, 5e-5);
}

}  // namespace
}  // namespace tandem
