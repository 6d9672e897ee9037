#pragma once

#include <optional>

#include "tandem/coordination/stability.h"

/// \file
/// Whether a contact lasts. Contact never pulls, so motion that grows opens it, and it closes
/// again.
#pragma GCC visibility push(default)
namespace tandem {

/// Speed after one touch of a remote user, over that before: a hand flies on to the user, who does
/// not answer yet. Above 1 a touch gains energy. 0: it stays in touch for 1 s. Mean over the
/// moments in a tick at which the touch may begin; the same for any speed. A dynamic proxy of the
/// hand's mass takes most of it along. Throws as computeGrowth() does, and for a cooperation with
/// an object.
[[nodiscard]] double computeRestitution(const LoopSettings& settings);

/// Tells how the contact of two users goes on, once a hand begins to push steadily.
struct ContactOutlook {
  /// Motion with lasting contact grows (computeWorstRate() >= 0): it comes and goes as long as the
  /// users push, about once in a round trip.
  bool comes_and_goes = false;
  double period = 0.0;       ///< of that, without the touch itself [s]
  double restitution = 0.0;  ///< of a touch
  /// About how often the contact of who pushes a held user changes until it rests. A rule from
  /// runs: 1 + 2 ln(1/2) / ln(e). Empty for e >= 0.99, which hardly rests, and for a dynamic proxy,
  /// which yields.
  std::optional<double> changes;
};

/// Throws as computeRestitution() does.
[[nodiscard]] ContactOutlook computeOutlook(const LoopSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
