// The largest eigenvalue by Arnoldi's iteration is that of all eigenvalues.
#include "coordination/src/stability/dominant.h"

#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "tandem/coordination/stability.h"

#include "coordination/src/stability/monodromy.h"
#include "support/random.h"

namespace tandem {
namespace {

using stability::computeDominant;
using stability::computeEigenvector;

double computeRadius(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues().cwiseAbs().maxCoeff();
}

/// A loop with many packets on their way, drawn.
LoopSettings drawLongLoop(test::Random& random, int i) {
  LoopSettings settings;
  settings.stand_in = static_cast<StandInKind>(i % 3);
  settings.packet_rate = i % 4 == 0 ? 60.0 : 128.0;
  settings.delay = random.logUniform(0.15, 0.5);
  settings.coordination = {random.logUniform(10.0, 2000.0), random.logUniform(1.0, 100.0)};
  settings.contact = {random.logUniform(100.0, 8000.0), random.logUniform(0.2, 5.0)};
  settings.device_damping = random.logUniform(0.1, 10.0);
  return settings;
}

TEST(Dominant, IsTheLargestOfLoopsWithManyPackets) {
  constexpr std::uint64_t kSeed = 21;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int i = 0; i < 24; ++i) {
    const LoopSettings settings = drawLongLoop(random, i);
    for (const MotionMode mode : {MotionMode::kCommon, MotionMode::kDifference}) {
      const double rate = computeGrowthRate(settings, mode);
      const double cycle = settings.packet_rate == 60.0 ? 0.05 : 0.125;
      const double largest = std::abs(computeMultipliers(settings, mode).front());
      EXPECT_NEAR(rate, std::log(largest) / cycle, 1e-9) << i;
    }
  }
}

TEST(Dominant, HasItsEigenvector) {
  LoopSettings settings;
  settings.delay = 0.3;
  for (const StandInKind kind : {StandInKind::kNone, StandInKind::kHeld, StandInKind::kDynamic}) {
    settings.stand_in = kind;
    const stability::Monodromy loop(stability::makeModeModel(settings, MotionMode::kDifference));
    const Eigen::MatrixXd matrix = loop.makeMatrix();
    const std::complex<double> value = computeDominant(matrix);
    const Eigen::VectorXcd vector = computeEigenvector(matrix, value);
    EXPECT_NEAR(vector.norm(), 1.0, 1e-12);
    EXPECT_LT((matrix * vector - value * vector).norm(), 1e-8 * matrix.norm());
  }
}

// Matrices that an iteration finds hard: no gap, two that are equal in size, a rank of one.
TEST(Dominant, IsRightForAnyMatrix) {
  test::Random random(5);
  for (const int size : {1, 2, 79, 81, 160}) {
    Eigen::MatrixXd matrix(size, size);
    for (double& value : matrix.reshaped()) value = random.uniform(-1.0, 1.0);
    EXPECT_NEAR(std::abs(computeDominant(matrix)), computeRadius(matrix), 1e-9) << size;
    const Eigen::MatrixXd turned = matrix - matrix.transpose();
    EXPECT_NEAR(std::abs(computeDominant(turned)), computeRadius(turned), 1e-9) << size;
    const Eigen::MatrixXd thin = matrix.col(0) * matrix.row(0);
    EXPECT_NEAR(std::abs(computeDominant(thin)), computeRadius(thin), 1e-9) << size;
  }
}

}  // namespace
}  // namespace tandem
