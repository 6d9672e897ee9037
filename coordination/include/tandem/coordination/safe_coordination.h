#pragma once

#include <optional>

#include "tandem/coordination/stability.h"

/// \file
/// Gains of coordination for a delay, where a user has none in mind.
#pragma GCC visibility push(default)
namespace tandem {

/// Gains that are given; empty ones are to be chosen.
struct GivenCoordination {
  std::optional<double> stiffness;  ///< K_t [N/m]
  std::optional<double> damping;    ///< B_t [N s/m]
};

/// Gains of coordination, and how they were found.
struct SafeCoordination {
  CouplerGains gains;
  /// Stable with empty hands. False: while hands hold their devices, or least unstable.
  bool is_for_empty_hands = false;
  double rate = 0.0;  ///< of the worst motion, with empty hands [1/s]
};

/// Chooses the stiffest coordination whose motion falls to 1/e within 50 delays, and which is
/// stable with twice K_t, with 1.5 times more and less B_t, and half a packet period earlier and
/// later. If none is with empty hands, they hold their devices as kHeldHand does. If none is then,
/// the least unstable one is chosen. Of `settings` all counts but the gains to be chosen. Gains are
/// rounded down to two digits, so that all computers choose the same. Throws as computeGrowth()
/// does.
[[nodiscard]] SafeCoordination chooseCoordination(const LoopSettings& settings,
                                                  const GivenCoordination& given = {});

}  // namespace tandem
#pragma GCC visibility pop
