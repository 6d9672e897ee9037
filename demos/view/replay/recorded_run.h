#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "replay/recorded_hand.h"
#include "replay/recorded_scene.h"
#include "scenario/scenario.h"

namespace tandem::view {

/// What was recorded of one site.
struct RecordedSite {
  RecordedScene scene;
  std::vector<HandMoment> hand;
};

/// A run as its folder has it: of all sites, or of one of a live run.
struct RecordedRun {
  std::filesystem::path summary;  ///< its file, for messages
  demos::Scenario scenario;
  std::vector<std::optional<RecordedSite>> sites;  ///< of the scenario; empty: not recorded
  double duration = 0.0;                           ///< until the last tick or frame [s]

  [[nodiscard]] bool has(int site) const {
    const auto at = static_cast<std::size_t>(site);
    return at < sites.size() && sites[at].has_value();
  }
};

/// Reads a folder of `tandem run`, or of one or two `tandem peer`. Each file is read once. Throws
/// UsageError, one line with file, line or key, and remedy.
[[nodiscard]] RecordedRun loadRecordedRun(const std::filesystem::path& folder);

}  // namespace tandem::view
