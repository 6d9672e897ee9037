#include "stability/drawn/simulated_growth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "tandem/coordination/stability_advice.h"

namespace tandem::test {
namespace {

// Speeds that a device gets [m/s]: more if the deviation should fade.
constexpr double kNudge = 1e-7, kFadingNudge = 1e-4;
constexpr double kNoise = 3e-15;      // rounding in speeds [m/s]
constexpr double kLeastPart = 1e-6;   // of the nudge: smallest deviation that counts
constexpr double kCalmEnough = 0.5;   // [1/s]: what is slow needs no calm
constexpr double kLongestCalm = 8.0;  // [s]

/// Hands that calm the start, and the rate at which they do.
struct Calm {
  HandImpedance hand;
  double rate = std::numeric_limits<double>::infinity();
};

/// The softest hands that calm within a second, or else the best.
Calm findCalm(const LoopSettings& settings) {
  Calm best;
  for (const auto& [stiffness, damping] : {std::pair{0.0, 0.0},
                                           {0.0, 2.0},
                                           {0.0, 6.0},
                                           {0.0, 20.0},
                                           {300.0, 5.0},
                                           {300.0, 15.0},
                                           {1000.0, 10.0},
                                           {1000.0, 30.0},
                                           {3000.0, 60.0}}) {
    LoopSettings calmed = settings;
    calmed.hand.stiffness += stiffness;
    calmed.hand.damping += damping;
    const double rate = computeWorstRate(calmed);
    if (rate < best.rate) best = {{0.0, stiffness, damping}, rate};
    if (rate < -3.0) break;
  }
  return best;
}

Signal makeSignal(const LoopSettings& settings, long ticks) {
  const auto haptic = std::lround(settings.haptic_rate);
  const auto packets = std::lround(settings.packet_rate);
  return {Eigen::MatrixXd(settings.has_object ? 2 : 1, ticks),
          static_cast<int>(haptic / std::gcd(haptic, packets)), settings.haptic_rate,
          2.0 * settings.delay, kNoise};
}

/// Fits the first `count` samples, without the start and what is too small.
FittedGrowth fitMode(Signal& signal, long count, double least) {
  const auto part = std::lround(0.2 * signal.sample_rate);
  const auto largest = [&](long from) {
    return signal.samples.middleCols(from, part).cwiseAbs().maxCoeff();
  };
  if (count < part) return {};
  const double first = largest(0);
  long end = count;
  while (end >= part && largest(end - part) < least) end -= part;
  const long start = end / 5;
  signal.samples = signal.samples.middleCols(start, end - start).eval();
  FittedGrowth fit = fitGrowth(signal);
  // What fades at once is not fitted; at least it fades as fast as this.
  if (fit.modes == 0 && end < count)
    fit.rate = std::log(least / first) * signal.sample_rate / static_cast<double>(end + part);
  return fit;
}

/// Both modes have a part in it.
Eigen::VectorXd makeImpulses(const LoopSettings& settings, double speed) {
  Eigen::VectorXd impulses(settings.users);
  const double impulse = speed * (settings.device_mass + settings.hand.mass);
  for (int i = 0; i < settings.users; ++i)
    impulses(i) = impulse * (1.0 + 0.6 * std::cos(2.4 * i + 0.3));
  return impulses;
}

}  // namespace

std::optional<SimulatedGrowth> simulateGrowth(const LoopSettings& settings, double duration,
                                              Keeping keeping) {
  const Calm calm = findCalm(settings);
  if (!(calm.rate < kCalmEnough)) return std::nullopt;
  PressedSites still(settings, calm.hand, keeping), nudged(settings, calm.hand, keeping);
  const double settled =
      PressingHand::kRise + (calm.rate < 0.0 ? std::min(-20.0 / calm.rate, kLongestCalm) : 0.5);
  while (still.now() < settled) {
    still.tick();
    nudged.tick();
  }
  still.letGo();
  nudged.letGo();
  const double speed = computeWorstRate(settings) < 0.0 ? kFadingNudge : kNudge;
  nudged.nudge(makeImpulses(settings, speed));

  const long ticks = std::lround(duration * settings.haptic_rate);
  const Eigen::Index users = settings.users;
  Signal common = makeSignal(settings, ticks), difference = common;
  long k = 0;
  for (; k < ticks; ++k) {
    still.tick();
    nudged.tick();
    if (std::min(still.findLeastDepth(), nudged.findLeastDepth()) <= 0.0) break;
    const Eigen::VectorXd deviation = nudged.velocities() - still.velocities();
    for (Eigen::Index row = 0; row < common.samples.rows(); ++row) {
      const auto all = deviation.segment(row * users, users);
      common.samples(row, k) = all.mean();
      difference.samples(row, k) = all(0) - all.mean();
    }
  }
  return SimulatedGrowth{fitMode(common, k, kLeastPart * speed),
                         fitMode(difference, k, kLeastPart * speed),
                         static_cast<double>(k) / settings.haptic_rate};
}

}  // namespace tandem::test
