#include "run/run_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

std::string nameSite(std::size_t site) { return fmt::format("site{}", site + 1); }

/// Adds what only more than two sites have: the summary of two stays as it was.
void describeMany(const RunSummary& s, nlohmann::json& j) {
  for (const PairCoherency& pair : s.pairs)
    j["coherency"]["pairs"].push_back(
        {{"i", pair.one + 1}, {"j", pair.other + 1}, {"mean", pair.mean}, {"max", pair.max}});
  const auto drag = s.common_motion.drag();
  j["drag"] = {{"force", s.common_motion.force},
               {"speed", s.common_motion.speed},
               {"per_speed", drag ? nlohmann::json(*drag) : nlohmann::json()}};
  for (std::size_t own = 0; own < s.felt.size(); ++own)
    j["contacts"][nameSite(own)] = describeFelt(s.felt[own], own);
}

/// Files of live sites, which a run replaces.
std::vector<std::string> listLiveFiles() {
  std::vector<std::string> files;
  for (std::size_t site = 0; site < kMostSites; ++site) {
    files.push_back(nameSite(site) + ".json");
    files.push_back(fmt::format("scene{}.csv", site + 1));
  }
  return files;
}

}  // namespace

nlohmann::json makeSummary(const Scenario& scenario, const VirtualRun& run) {
  const RunSummary& s = run.summary();
  nlohmann::json j;
  j["title"] = scenario.title;
  j["scenario"] = describeScenario(scenario);
  j["scalar"] = sizeof(btScalar) == 8 ? "float64" : "float";
  j["coherency"] = {{"mean_abs", s.coherency_mean}, {"max_abs", s.coherency_max}};
  for (std::size_t site = 0; site < s.sites.size(); ++site)
    j[nameSite(site)] = describeSite(s.sites[site]);
  if (s.sites.size() > kFewestSites) describeMany(s, j);
  j["scene"]["bodies"] = run.scene().describeBodies();
  j["state_hash"] = fmt::format("{:016x}", s.state_hash);
  j["real_time_factor"] = s.real_time_factor;
  return j;
}

void writeRun(const OutputFolder& folder, const nlohmann::json& summary, const VirtualRun& run) {
  for (int s = 0; s < run.siteCount(); ++s)
    run.recording(s).writeCsv(folder / fmt::format("site{}.csv", s + 1), run.frame().q_WS);
  run.scene().writeCsv(folder / "scene.csv");
  writeText(folder / "summary.json", summary.dump(2) + "\n");
  std::vector<std::string> older = listLiveFiles();
  for (std::size_t site = run.summary().sites.size(); site < kMostSites; ++site)
    older.push_back(nameSite(site) + ".csv");
  folder.publish("summary.json", older);
}

}  // namespace tandem::demos
