#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#include "falcon/src/novint/falcon_kinematics.h"

namespace tandem::bench {

/// A Falcon's encoders: rounds a position to whole counts.
class CountedGrip {
 public:
  struct Reading {
    Vec3 counts = Vec3::Zero();  ///< counts of the three legs
    FalconPose pose;             ///< pose for these counts
  };

  /// Throws tandem::Error for a position out of reach.
  [[nodiscard]] Reading read(const Vec3& p_D);

 private:
  FalconKinematics kinematics_;
  Vec3 guess_D_ = Vec3(0.0, 0.0, 0.125);
};

/// A method that estimates the grip's velocity in D [m/s].
using Estimate = std::function<Vec3(double time, const CountedGrip::Reading& reading)>;

struct Candidate {
  std::string name;
  std::string space;  ///< space of the estimate: "counts" of the legs, or "point" of the grip
  std::function<Estimate()> make;
};

[[nodiscard]] std::vector<Candidate> makeCandidates();

}  // namespace tandem::bench
