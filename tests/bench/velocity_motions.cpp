#include "velocity_motions.h"

#include <cmath>
#include <limits>

#include "support/random.h"

namespace tandem::bench {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kPeriod = 1e-3;      // [s]
constexpr double kJitter = 0.2e-3;    // to either side [s]
constexpr double kSettling = 0.1;     // excluded at the start [s]
constexpr int kLines = 24;            // number of directions and places
constexpr double kLongestLag = 0.03;  // longest lag searched [s]
constexpr double kLagStep = 0.05e-3;  // [s]

// A hand at rest with a tremor of 20 um at 9 Hz.
double restWay(double t) { return 20e-6 * std::sin(2.0 * kPi * 9.0 * t); }
double restVelocity(double t) { return 20e-6 * 2.0 * kPi * 9.0 * std::cos(2.0 * kPi * 9.0 * t); }

double slowWay(double t) { return 1e-3 * t; }
double slowVelocity(double) { return 1e-3; }

double strokeWay(double t) { return 0.1 * t; }
double strokeVelocity(double) { return 0.1; }

double sineWay(double t) { return 0.01 * std::sin(2.0 * kPi * 3.0 * t); }
double sineVelocity(double t) { return 0.01 * 2.0 * kPi * 3.0 * std::cos(2.0 * kPi * 3.0 * t); }

// From -50 mm/s to 50 mm/s at 5 m/s^2: a hyperbola.
constexpr double kTurnSpeed = 0.05, kTurnRadius = kTurnSpeed * kTurnSpeed / 5.0;
double turnWay(double t) { return std::hypot(kTurnSpeed * t, kTurnRadius); }
double turnVelocity(double t) { return kTurnSpeed * kTurnSpeed * t / turnWay(t); }

struct Estimated {
  double time;  // time at which the estimate should be true [s]
  Vec3 along;   // unit vector of the line
  Vec3 v_D;
};

std::vector<Estimated> estimate(const Candidate& candidate, const Motion& motion, Timing timing) {
  test::Random random(11);
  std::vector<Estimated> result;
  for (int line = 0; line < kLines; ++line) {
    const Vec3 along = random.direction();
    const Vec3 middle_D = Vec3(0.0, 0.0, 0.125) + random.inCube(0.005);
    CountedGrip grip;
    const Estimate add = candidate.make();
    const int ticks = static_cast<int>(std::lround(motion.duration / kPeriod));
    for (int i = 0; i < ticks; ++i) {
      const double even = i * kPeriod - 0.5 * motion.duration;
      const double off = timing == Timing::kEven ? 0.0 : random.uniform(-kJitter, kJitter);
      const CountedGrip::Reading reading = grip.read(middle_D + motion.way(even + off) * along);
      const double stamp = timing == Timing::kUnknown ? even : even + off;
      const Vec3 v_D = add(stamp, reading);
      if (i * kPeriod >= kSettling) result.push_back({stamp, along, v_D});
    }
  }
  return result;
}

double errorOf(const std::vector<Estimated>& estimates, const Motion& motion, double lag) {
  double sum = 0.0;
  for (const Estimated& e : estimates)
    sum += (e.v_D - motion.velocity(e.time - lag) * e.along).squaredNorm();
  return std::sqrt(sum / static_cast<double>(estimates.size()));
}

}  // namespace

std::vector<Motion> makeMotions() {
  return {{"rest", 2.0, false, restWay, restVelocity},
          {"slow", 4.0, false, slowWay, slowVelocity},
          {"stroke", 0.6, false, strokeWay, strokeVelocity},
          {"sine", 1.1, true, sineWay, sineVelocity},
          {"turn", 0.4, true, turnWay, turnVelocity}};
}

Accuracy measureAccuracy(const Candidate& candidate, const Motion& motion, Timing timing) {
  const std::vector<Estimated> estimates = estimate(candidate, motion, timing);
  Accuracy result;
  result.error = result.noise = errorOf(estimates, motion, 0.0);
  if (!motion.has_lag) return result;
  for (int i = 1; i * kLagStep <= kLongestLag; ++i) {
    const double noise = errorOf(estimates, motion, i * kLagStep);
    if (noise >= result.noise) break;
    result.noise = noise;
    result.lag = i * kLagStep;
  }
  return result;
}

}  // namespace tandem::bench
