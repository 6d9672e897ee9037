#include "tandem/coordination/stability.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "stability/dominant.h"
#include "stability/loop_checks.h"
#include "stability/monodromy.h"

namespace tandem {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Leaves out the multiplier 1 of a motion that nothing holds: everything moved along. It must not
/// hide one that is near 1, so it is taken out before multipliers are computed.
Eigen::MatrixXd deflate(const Eigen::MatrixXd& matrix, Eigen::VectorXd shift) {
  constexpr double kFree = 1e-8;
  if ((matrix * shift - shift).norm() > kFree * shift.norm()) return matrix;
  // Householder: H e = |e| e_1.
  Eigen::VectorXd u = shift;
  u(0) += shift.norm();
  u.normalize();
  const auto reflect = [&](Eigen::MatrixXd m) {
    m -= 2.0 * u * (u.transpose() * m).eval();
    m -= 2.0 * (m * u).eval() * u.transpose();
    return m;
  };
  const Eigen::MatrixXd reflected = reflect(matrix);
  const Eigen::Index n = matrix.rows() - 1;
  return reflected.bottomRightCorner(n, n);
}

std::complex<double> findMultiplier(const stability::Monodromy& loop,
                                    const Eigen::MatrixXd& matrix) {
  return stability::computeDominant(deflate(matrix, loop.makeShift()));
}

double computeRate(const stability::Monodromy& loop, std::complex<double> multiplier) {
  return std::log(std::abs(multiplier)) / loop.period();
}

double computeRate(const stability::Monodromy& loop) {
  return computeRate(loop, findMultiplier(loop, loop.makeMatrix()));
}

/// Turns of a device's velocity over a cycle, from tick to tick: several a period of the cycle
/// would look like fewer at its ends.
double computeFrequency(const std::vector<std::complex<double>>& velocities,
                        std::complex<double> multiplier, double period) {
  double turn = 0.0;
  int changes = 0;
  for (std::size_t k = 0; k < velocities.size(); ++k) {
    const std::complex<double> now = velocities[k];
    const std::complex<double> next =
        k + 1 < velocities.size() ? velocities[k + 1] : multiplier * velocities[0];
    turn += std::arg(next * std::conj(now));
    changes += now.real() * next.real() < 0.0;
  }
  const bool is_real = multiplier.imag() == 0.0;
  return is_real ? 0.5 * changes / period : std::abs(turn) / (2.0 * kPi * period);
}

/// The user whose device moves fastest, in a motion.
int findFastest(const stability::Monodromy& loop, const Eigen::VectorXcd& state,
                const LoopSettings& settings) {
  int fastest = 0;
  if (settings.areUsersAlike()) return fastest;
  const auto speed = [&](int user) { return std::abs(state(loop.deviceVelocity(user))); };
  for (int user = 1; user < settings.users; ++user)
    if (speed(user) > speed(fastest)) fastest = user;
  return fastest;
}

std::vector<double> compareDevices(const stability::Monodromy& loop, const Eigen::VectorXcd& state,
                                   int fastest, const LoopSettings& settings) {
  const std::complex<double> most = state(loop.deviceVelocity(fastest));
  std::vector<double> shares;
  for (int user = 0; user < settings.users; ++user) {
    const std::complex<double> share = state(loop.deviceVelocity(user)) / most;
    shares.push_back(std::copysign(std::abs(share), share.real()));
  }
  return shares;
}

}  // namespace

const char* name(MotionMode mode) noexcept {
  switch (mode) {
    case MotionMode::kCommon:
      return "common";
    case MotionMode::kDifference:
      return "difference";
    case MotionMode::kAny:
      return "any";
    case MotionMode::kDeaf:
      break;
  }
  return "deaf";
}

std::vector<MotionMode> listLastingModes(const LoopSettings& settings) {
  if (settings.areUsersAlike()) return {MotionMode::kCommon, MotionMode::kDifference};
  return {MotionMode::kAny};
}

std::vector<MotionMode> listModes(const LoopSettings& settings) {
  std::vector<MotionMode> modes = listLastingModes(settings);
  modes.push_back(MotionMode::kDeaf);
  return modes;
}

double computeGrowthRate(const LoopSettings& settings, MotionMode mode) {
  stability::checkLoop(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  return computeRate(loop);
}

double computeRateAtPhase(const LoopSettings& settings, double phase) {
  stability::checkLoop(settings);
  stability::checkPhase(phase);
  std::vector<double> phases(static_cast<std::size_t>(settings.users), phase);
  phases.front() = 0.0;
  const stability::Monodromy loop(stability::makeFullModel(settings, phases));
  return computeRate(loop);
}

Growth computeGrowth(const LoopSettings& settings, MotionMode mode) {
  stability::checkLoop(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  const Eigen::MatrixXd matrix = loop.makeMatrix();
  const std::complex<double> multiplier = findMultiplier(loop, matrix);
  const Eigen::VectorXcd state = stability::computeEigenvector(matrix, multiplier);
  const int fastest = findFastest(loop, state, settings);
  Growth growth{computeRate(loop, multiplier),
                computeFrequency(loop.watchDevice(state, fastest), multiplier, loop.period()),
                {}};
  if (!settings.areUsersAlike()) growth.shares = compareDevices(loop, state, fastest, settings);
  return growth;
}

// In a steady motion by v each cycle moves the state on by v P: (M - I) y + F g = v P e. A motion
// of everything along changes nothing, so the first position of y is 0, and F takes its column.
double computeDrag(const LoopSettings& settings) {
  stability::checkLoop(settings);
  if (settings.hand.stiffness != 0.0)
    throw std::invalid_argument("hand.stiffness: must be 0, as such a hand lets nothing move on");
  const stability::Monodromy loop(
      stability::makeModeModel(settings, listLastingModes(settings).front()));
  Eigen::MatrixXd equations = loop.makeMatrix();
  equations.diagonal().array() -= 1.0;
  equations.col(0) = loop.makePush();
  return equations.colPivHouseholderQr().solve(loop.period() * loop.makeShift())(0);
}

double findAnalysedPacketRate(const LoopSettings& settings) {
  stability::checkLoop(settings);
  return stability::roundPacketRate(settings);
}

std::vector<std::complex<double>> computeMultipliers(const LoopSettings& settings,
                                                     MotionMode mode) {
  stability::checkLoop(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(deflate(loop.makeMatrix(), loop.makeShift()),
                                                   false);
  const Eigen::VectorXcd& values = solver.eigenvalues();
  std::vector<std::complex<double>> all(values.data(), values.data() + values.size());
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return all;
}

}  // namespace tandem
