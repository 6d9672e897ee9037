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

}  // namespace

RecordedRun loadRecordedRun(const fs::path& folder) {
  std::error_code ignored;
  const auto siteFile = [&](int site, const char* end) {
    return folder / fmt::format("site{}{}", site + 1, end);
  };
  const bool is_whole = fs::exists(folder / "summary.json", ignored);
  if (is_whole ||
      !(fs::exists(siteFile(0, ".json"), ignored) || fs::exists(siteFile(1, ".json"), ignored)))
    return loadWhole(folder);
  RecordedRun run;
  for (int site : {1, 0}) {
    if (!fs::exists(siteFile(site, ".json"), ignored)) continue;
    RunSummary summary = readRunSummary(siteFile(site, ".json"));
    run.summary = summary.file;
    run.scenario = std::move(summary.scenario);
    auto scenes = readRecordedScenes(folder / fmt::format("scene{}.csv", site + 1), summary.bodies);
    addSite(run, site, folder, std::move(scenes[static_cast<std::size_t>(site)]));
  }
  return run;
}

}  // namespace tandem::view
