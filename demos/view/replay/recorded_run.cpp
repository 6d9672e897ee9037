#include "replay/recorded_run.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include <fmt/format.h>

#include "replay/recorded_summary.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

fs::path summaryOf(const fs::path& folder, int site) {
  return folder / fmt::format("site{}.json", site + 1);
}

/// Adds what one summary and its scene tell of some sites.
void addSites(RecordedRun& run, const fs::path& summary_file, const fs::path& scene_file,
              std::initializer_list<int> sites) {
  RecordedSummary summary = readRecordedSummary(summary_file);
  run.summary = summary_file;
  run.scenario = std::move(summary.scenario);
  auto scenes = readRecordedScenes(scene_file, summary.bodies);
  for (const int site : sites) {
    const auto at = static_cast<std::size_t>(site);
    RecordedSite& recorded = run.sites[at].emplace();
    recorded.scene = std::move(scenes[at]);
    recorded.hand =
        readRecordedHand(summary_file.parent_path() / fmt::format("site{}.csv", site + 1));
    run.duration = std::max({run.duration, recorded.scene.times.back(), recorded.hand.back().time});
  }
}

}  // namespace

RecordedRun loadRecordedRun(const fs::path& folder) {
  std::error_code ignored;
  const auto exists = [&](const fs::path& file) { return fs::exists(file, ignored); };
  RecordedRun run;
  const bool has_site = exists(summaryOf(folder, 0)) || exists(summaryOf(folder, 1));
  if (exists(folder / "summary.json") || !has_site) {
    // `tandem run` wrote it, in virtual time.
    addSites(run, folder / "summary.json", folder / "scene.csv", {0, 1});
    return run;
  }
  // `tandem peer` wrote it: each site has files of its own. The first site's scenario stays.
  for (const int site : {1, 0})
    if (exists(summaryOf(folder, site)))
      addSites(run, summaryOf(folder, site), folder / fmt::format("scene{}.csv", site + 1), {site});
  return run;
}

}  // namespace tandem::view
