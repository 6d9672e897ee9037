#include "replay/recorded_run.h"

#include <algorithm>

#include <fmt/format.h>

#include "replay/run_file.h"
#include "replay/run_summary.h"

namespace tandem::view {
namespace {

namespace fs = std::filesystem;

void addSite(RecordedRun& run, int site, const fs::path& folder, RecordedScene scene) {
  RecordedSite recorded;
  recorded.scene = std::move(scene);
  recorded.hand = readRecordedHand(folder / fmt::format("site{}.csv", site + 1));
  run.duration = std::max({run.duration, recorded.scene.times.back(), recorded.hand.back().time});
  run.sites[static_cast<std::size_t>(site)] = std::move(recorded);
}

/// Of `tandem run`, in virtual time.
RecordedRun loadWhole(const fs::path& folder) {
  RecordedRun run;
  RunSummary summary = readRunSummary(folder / "summary.json");
  run.summary = summary.file;
  run.scenario = std::move(summary.scenario);
  auto scenes = readRecordedScenes(folder / "scene.csv", summary.bodies);
  for (int site : {0, 1})
    addSite(run, site, folder, std::move(scenes[static_cast<std::size_t>(site)]));
  return run;
}

fs::path summaryOf(const fs::path& folder, int site) {
  return folder / fmt::format("site{}.json", site + 1);
}

/// Of `tandem peer`: one site or both, each with files of its own.
RecordedRun loadSites(const fs::path& folder) {
  RecordedRun run;
  std::error_code ignored;
  for (int site : {1, 0}) {  // the first site's scenario stays
    if (!fs::exists(summaryOf(folder, site), ignored)) continue;
    RunSummary summary = readRunSummary(summaryOf(folder, site));
    run.summary = summary.file;
    run.scenario = std::move(summary.scenario);
    auto scenes = readRecordedScenes(folder / fmt::format("scene{}.csv", site + 1), summary.bodies);
    addSite(run, site, folder, std::move(scenes[static_cast<std::size_t>(site)]));
  }
  return run;
}

}  // namespace

RecordedRun loadRecordedRun(const fs::path& folder) {
  std::error_code ignored;
  const auto exists = [&](const fs::path& file) { return fs::exists(file, ignored); };
  const bool has_site = exists(summaryOf(folder, 0)) || exists(summaryOf(folder, 1));
  return has_site && !exists(folder / "summary.json") ? loadSites(folder) : loadWhole(folder);
}

}  // namespace tandem::view
