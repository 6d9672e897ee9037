#pragma once

#include "live_pair.h"

namespace tandem::bench {

/// Results of a run that was recorded at both sites.
struct RunFigures {
  double force_mean = 0.0, force_max = 0.0;          ///< force at site 1 [N]
  double coherency_mean = 0.0, coherency_max = 0.0;  ///< |object at 1 - object at 2| [m]
};

/// A scenario in virtual time and in real time.
struct BesideVirtual {
  RunFigures virtual_time, live;
  LivePairReport report;
};

[[nodiscard]] BesideVirtual runBesideVirtual(const demos::Scenario& scenario,
                                             LivePairSettings settings);

}  // namespace tandem::bench
