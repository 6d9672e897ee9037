#pragma once

#include <filesystem>
#include <vector>

#include "replay/recorded_scene.h"
#include "scenario/scenario.h"

namespace tandem::view {

/// The parts of a run's summary that its pictures need.
struct RecordedSummary {
  demos::Scenario scenario;
  std::vector<RecordedBody> bodies;  ///< at least one
};

/// Reads summary.json, or site1.json of a live run. Throws UsageError with file, line or key, and
/// remedy.
[[nodiscard]] RecordedSummary readRecordedSummary(const std::filesystem::path& file);

}  // namespace tandem::view
