#pragma once

#include <string>
#include <vector>

#include "velocity_candidates.h"

namespace tandem::bench {

/// How a reading's time is off the even 1 kHz.
enum class Timing {
  kEven,
  kKnown,   ///< by up to 0.2 ms, and stamped with when it was taken
  kUnknown  ///< the same, stamped as if it were even
};

/// How far an estimate is from the true velocity.
struct Accuracy {
  double error = 0.0;  ///< root of the mean square [m/s]
  double lag = 0.0;    ///< by which it fits best [s]; where the velocity is constant, 0
  double noise = 0.0;  ///< error that is left once the lag is taken away [m/s]
};

struct Motion {
  std::string name;
  double duration = 1.0;                   ///< [s], from -duration / 2
  bool has_lag = false;                    ///< false: a constant velocity shows none
  double (*way)(double t) = nullptr;       ///< along a line [m]
  double (*velocity)(double t) = nullptr;  ///< [m/s]
};

[[nodiscard]] std::vector<Motion> makeMotions();

/// Over lines of many directions and places in the middle of the workspace, the same for each call.
[[nodiscard]] Accuracy measureAccuracy(const Candidate& candidate, const Motion& motion,
                                       Timing timing);

}  // namespace tandem::bench
