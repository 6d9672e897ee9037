#include "velocity_candidates.h"

#include <cmath>
#include <optional>

#include "falcon/src/guard/velocity_estimator.h"

namespace tandem::bench {
namespace {

/// A critically damped observer of position and velocity with one memory, 0 to 1. It is only here
/// for comparison, not in the library.
class AlphaBeta {
 public:
  explicit AlphaBeta(double memory) : memory_(memory) {}

  Vec3 add(double time, const Vec3& p) {
    const double dt = time - time_;
    time_ = time;
    if (!was_read_) {
      was_read_ = true;
      p_ = p;
      return v_;
    }
    const Vec3 error = p - (p_ + v_ * dt);
    p_ += v_ * dt + (1.0 - memory_ * memory_) * error;
    v_ += (1.0 - memory_) * (1.0 - memory_) / dt * error;
    return v_;
  }

 private:
  double memory_;
  double time_ = 0.0;
  Vec3 p_ = Vec3::Zero(), v_ = Vec3::Zero();
  bool was_read_ = false;
};

template <typename Estimator>
Candidate inCounts(const std::string& name, Estimator estimator) {
  return {name, "counts", [estimator] {
            return [used = estimator](double time, const CountedGrip::Reading& reading) mutable {
              const Vec3 rates = angleRatesOfCounts(used.add(time, reading.counts));
              return computeVelocity(reading.pose, rates).value_or(Vec3::Zero());
            };
          }};
}

template <typename Estimator>
Candidate atPoint(const std::string& name, Estimator estimator) {
  return {name, "point", [estimator] {
            return [used = estimator](double time, const CountedGrip::Reading& reading) mutable {
              return used.add(time, reading.pose.p_D);
            };
          }};
}

}  // namespace

CountedGrip::Reading CountedGrip::read(const Vec3& p_D) {
  const std::optional<FalconAngles> angles = kinematics_.computeAngles(p_D);
  if (!angles) throw Error("the grip's way leaves the Falcon's reach; make it shorter");
  Reading reading;
  FalconAngles counted;
  for (Eigen::Index leg = 0; leg < 3; ++leg) {
    reading.counts[leg] = std::round(countsOfAngle((*angles)[leg]));
    counted[leg] = angleOfCounts(reading.counts[leg]);
  }
  const std::optional<FalconPose> pose = kinematics_.computePoseOfAngles(counted, guess_D_);
  if (!pose) throw Error("the counted angles have no pose; make the grip's way shorter");
  reading.pose = *pose;
  guess_D_ = pose->p_D;
  return reading;
}

std::vector<Candidate> makeCandidates() {
  constexpr double kStep = 40e-6;  // step of the grip per count at the workspace's centre [m]
  constexpr double kStamps = 0.4e-3;
  const auto kEnds = WindowFit::kEnds, kBest = WindowFit::kBest;
  const auto window = [](double tolerance, double stamp_error, double longest, WindowFit fit) {
    return AdaptiveWindow({tolerance, stamp_error, longest, fit});
  };
  return {
      atPoint("first difference", FirstDifference()),
      inCounts("first difference", FirstDifference()),
      atPoint("low-pass 30 Hz", LowPassDifference(30.0)),
      inCounts("low-pass 15 Hz", LowPassDifference(15.0)),
      inCounts("low-pass 30 Hz", LowPassDifference(30.0)),
      inCounts("low-pass 60 Hz", LowPassDifference(60.0)),
      inCounts("low-pass 120 Hz", LowPassDifference(120.0)),
      inCounts("alpha-beta 0.5", AlphaBeta(0.5)),
      inCounts("alpha-beta 0.6", AlphaBeta(0.6)),
      inCounts("alpha-beta 0.7", AlphaBeta(0.7)),
      inCounts("ends, 0.5, 0, 16 ms", window(0.5, 0.0, 0.016, kEnds)),
      inCounts("ends, 1, 0, 16 ms", window(1.0, 0.0, 0.016, kEnds)),
      inCounts("best, 0.5, 0, 16 ms", window(0.5, 0.0, 0.016, kBest)),
      inCounts("best, 0.7, 0, 16 ms", window(0.7, 0.0, 0.016, kBest)),
      inCounts("best, 1, 0, 16 ms", window(1.0, 0.0, 0.016, kBest)),
      inCounts("best, 1.5, 0, 16 ms", window(1.5, 0.0, 0.016, kBest)),
      inCounts("best, 0.7, 0.4, 16 ms", window(0.7, kStamps, 0.016, kBest)),
      inCounts("best, 0.7, 0.4, 32 ms", window(0.7, kStamps, 0.032, kBest)),
      inCounts("ends, 0.7, 0.4, 8 ms", window(0.7, kStamps, 0.008, kEnds)),
      atPoint("usual: best, 0.7, 0.4, 8", makeUsualVelocityEstimator(kStep)),
      inCounts("usual: best, 0.7, 0.4, 8", makeUsualVelocityEstimator()),
  };
}

}  // namespace tandem::bench
