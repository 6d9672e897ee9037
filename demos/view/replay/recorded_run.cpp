#include "replay/recorded_run.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "replay/recorded_summary.h"
#include "terminal/usage_error.h"

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
    if (at >= run.sites.size())
      throw demos::UsageError(fmt::format("{}: its scenario has {} sites; give one run's folder",
                                          summary_file.string(), run.sites.size()));
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
  std::vector<int> live_sites;
  for (int site = 0; site < static_cast<int>(demos::kMostSites); ++site)
    if (exists(summaryOf(folder, site))) live_sites.push_back(site);
  if (exists(folder / "summary.json") || live_sites.empty()) {
    // `tandem run` wrote it, in virtual time.
    addSites(run, folder / "summary.json", folder / "scene.csv");
    return run;
  }
  // `tandem peer` wrote it: each site has files of its own. The first site's scenario stays.
  for (auto site = live_sites.rbegin(); site != live_sites.rend(); ++site)
    addSites(run, summaryOf(folder, *site), folder / fmt::format("scene{}.csv", *site + 1),
             {*site});
  return run;
}

}  // namespace tandem::view
