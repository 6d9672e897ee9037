#include "replay/recorded_run.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "replay/recorded_summary.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

fs::path summaryOf(const fs::path& folder, int site) {
  return folder / fmt::format("site{}.json", site + 1);
}

/// Adds what one summary and its scene tell of some sites; none: of all that the scenario has.
void addSites(RecordedRun& run, const fs::path& summary_file, const fs::path& scene_file,
              std::vector<int> sites = {}) {
  RecordedSummary summary = readRecordedSummary(summary_file);
  run.summary = summary_file;
  run.scenario = std::move(summary.scenario);
  run.sites.resize(run.scenario.sites.size());
  auto scenes = readRecordedScenes(scene_file, summary.bodies, run.sites.size());
  if (sites.empty()) {
    sites.resize(run.sites.size());
    std::iota(sites.begin(), sites.end(), 0);
  }
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
    addSites(run, folder / "summary.json", folder / "scene.csv");
    return run;
  }
  // `tandem peer` wrote it: each site has files of its own. The first site's scenario stays.
  for (const int site : {1, 0})
    if (exists(summaryOf(folder, site)))
      addSites(run, summaryOf(folder, site), folder / fmt::format("scene{}.csv", site + 1), {site});
  return run;
}

}  // namespace tandem::view
