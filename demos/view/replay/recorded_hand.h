#pragma once

#include <filesystem>
#include <vector>

#include "tandem/coordination/types.h"

namespace tandem::view {

/// A user's hand at the start of one tick, in the scene's frame.
struct HandMoment {
  double time = 0.0;            ///< [s]
  Vec3 moved_S = Vec3::Zero();  ///< from where it was at the first tick [m]
  Vec3 force_S = Vec3::Zero();  ///< on the user [N]
};

/// Reads the hand from a site's table, such as site1.csv; at least one moment, in the order of
/// time. Throws UsageError with file, line and remedy.
[[nodiscard]] std::vector<HandMoment> readRecordedHand(const std::filesystem::path& file);

/// The last moment that is not after `time`, or the first.
[[nodiscard]] const HandMoment& findMoment(const std::vector<HandMoment>& hand, double time);

}  // namespace tandem::view
