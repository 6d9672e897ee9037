#include "tandem/coordination/stability.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "bad_value.h"
#include "stability/monodromy.h"

namespace tandem {
namespace {

constexpr double kPi = 3.14159265358979323846;

void check(const char* name, double value, bool is_good, const char* allowed) {
  if (!is_good || !std::isfinite(value)) throwBadValue(name, value, allowed);
}

void checkPositive(const char* name, double value) {
  check(name, value, value > 0.0, "a finite number above 0");
}

void checkNotNegative(const char* name, double value) {
  check(name, value, value >= 0.0, "a finite number, 0 or more");
}

void checkSettings(const LoopSettings& s) {
  check("users", s.users, s.users >= 2, "2 or more");
  checkPositive("object_mass", s.object_mass);
  checkNotNegative("object_damping", s.object_damping);
  checkNotNegative("contact.stiffness", s.contact.stiffness);
  checkNotNegative("contact.damping", s.contact.damping);
  checkNotNegative("coordination.stiffness", s.coordination.stiffness);
  checkNotNegative("coordination.damping", s.coordination.damping);
  checkPositive("proxy_mass", s.proxy_mass);
  checkNotNegative("proxy_damping", s.proxy_damping);
  checkPositive("device_mass", s.device_mass);
  checkNotNegative("device_damping", s.device_damping);
  checkNotNegative("hand.mass", s.hand.mass);
  checkNotNegative("hand.stiffness", s.hand.stiffness);
  checkNotNegative("hand.damping", s.hand.damping);
  checkPositive("haptic_rate", s.haptic_rate);
  check("packet_rate", s.packet_rate, s.packet_rate > 0.0 && s.packet_rate <= s.haptic_rate,
        "above 0, at most the haptic rate");
  check("delay", s.delay, s.delay >= 0.0 && s.delay <= kLongestDelay,
        "0 to 0.5 s; packets on their way are states, and more of them take too long");
  if (!s.has_object && s.stand_in == StandInKind::kNone)
    throw std::invalid_argument(
        "has_object = 0: users who are felt through shared objects only need one");
}

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

/// Multipliers of a cycle that `matrix` leads through.
Eigen::VectorXcd findMultipliers(const stability::Monodromy& loop, const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(deflate(matrix, loop.makeShift()), false);
  return solver.eigenvalues();
}

double computeRate(const stability::Monodromy& loop, const Eigen::MatrixXd& matrix) {
  return std::log(findMultipliers(loop, matrix).cwiseAbs().maxCoeff()) / loop.period();
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

}  // namespace

const char* name(MotionMode mode) noexcept {
  switch (mode) {
    case MotionMode::kCommon:
      return "common";
    case MotionMode::kDifference:
      return "difference";
    case MotionMode::kDeaf:
      break;
  }
  return "deaf";
}

double computeGrowthRate(const LoopSettings& settings, MotionMode mode) {
  checkSettings(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  return computeRate(loop, loop.makeMatrix());
}

double computeRateAtPhase(const LoopSettings& settings, double phase) {
  checkSettings(settings);
  check("phase", phase, phase >= 0.0 && phase <= 1.0, "0 to 1");
  std::vector<double> phases(static_cast<std::size_t>(settings.users), phase);
  phases.front() = 0.0;
  const stability::Monodromy loop(stability::makeFullModel(settings, phases));
  return computeRate(loop, loop.makeMatrix());
}

Growth computeGrowth(const LoopSettings& settings, MotionMode mode) {
  checkSettings(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  const Eigen::MatrixXd matrix = loop.makeMatrix();
  const double rate = computeRate(loop, matrix);
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  const double largest = std::exp(rate * loop.period());
  Eigen::Index worst = 0;
  (solver.eigenvalues().cwiseAbs().array() - largest).abs().minCoeff(&worst);
  const auto velocities = loop.watchDevice(solver.eigenvectors().col(worst), 0);
  return {rate, computeFrequency(velocities, solver.eigenvalues()(worst), loop.period())};
}

// In a steady motion by v each cycle moves the state on by v P: (M - I) y + F g = v P e. A motion
// of everything along changes nothing, so the first position of y is 0, and F takes its column.
double computeDrag(const LoopSettings& settings) {
  checkSettings(settings);
  if (settings.hand.stiffness != 0.0)
    throw std::invalid_argument("hand.stiffness: must be 0, as such a hand lets nothing move on");
  const stability::Monodromy loop(stability::makeModeModel(settings, MotionMode::kCommon));
  Eigen::MatrixXd equations = loop.makeMatrix();
  equations.diagonal().array() -= 1.0;
  equations.col(0) = loop.makePush();
  return equations.colPivHouseholderQr().solve(loop.period() * loop.makeShift())(0);
}

std::vector<std::complex<double>> computeMultipliers(const LoopSettings& settings,
                                                     MotionMode mode) {
  checkSettings(settings);
  const stability::Monodromy loop(stability::makeModeModel(settings, mode));
  const Eigen::VectorXcd values = findMultipliers(loop, loop.makeMatrix());
  std::vector<std::complex<double>> all(values.data(), values.data() + values.size());
  std::sort(all.begin(), all.end(),
            [](const auto& a, const auto& b) { return std::abs(a) > std::abs(b); });
  return all;
}

}  // namespace tandem
