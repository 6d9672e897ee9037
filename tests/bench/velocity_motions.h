#pragma once

#include <string>
#include <vector>

#include "velocity_candidates.h"

namespace tandem::bench {

/// Deviation of a reading's time from the even 1 kHz.
enum class Timing {
  kEven,
  kKnown,   ///< up to 0.2 ms, stamped with the time of the reading
  kUnknown  ///< the same, stamped as if even
};

/// Difference between an estimate and the true velocity.
struct Accuracy {
  double error = 0.0;  ///< root mean square [m/s]
  double lag = 0.0;    ///< lag of the best fit [s]; 0 for constant velocity
  double noise = 0.0;  ///< error that is left without the lag [m/s]
};

struct Motion {
  std::string name;
  double duration = 1.0;                   ///< begins at -duration / 2 [s]
  bool has_lag = false;                    ///< false: a constant velocity shows no lag
  double (*way)(double t) = nullptr;       ///< along a line [m]
  double (*velocity)(double t) = nullptr;  ///< [m/s]
};

[[nodiscard]] std::vector<Motion> makeMotions();

/// Averages over lines of many directions and places in the middle of the workspace, the same in
/// each call.
[[nodiscard]] Accuracy measureAccuracy(const Candidate& candidate, const Motion& motion,
                                       Timing timing);

}  // namespace tandem::bench
