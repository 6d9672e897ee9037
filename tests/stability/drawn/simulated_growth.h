#pragma once

#include <optional>

#include "tandem/coordination/stability.h"

#include "stability/drawn/multiplier_fit.h"
#include "stability/drawn/pressed_sites.h"

namespace tandem::test {

/// How small motions grow in the simulator.
struct SimulatedGrowth {
  FittedGrowth common, difference;
  double duration = 0.0;  ///< of the deviation, until its end or the first contact opens [s]

  [[nodiscard]] const FittedGrowth& worst() const noexcept {
    return common.rate > difference.rate ? common : difference;
  }
};

/// Lets all users press until all rests. Then two equal runs go on, one of them with a small push
/// on each device. The difference of both is free of the operating point, and small. Its mean over
/// the sites and what is left of it are the two modes. Nothing of the prediction goes in but the
/// hands that calm the start and the size of the push. Empty if no hands do.
[[nodiscard]] std::optional<SimulatedGrowth> simulateGrowth(const LoopSettings& settings,
                                                            double duration = 20.0,
                                                            Keeping keeping = Keeping::kGuide);

}  // namespace tandem::test
