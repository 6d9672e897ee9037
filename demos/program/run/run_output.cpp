#include "run/run_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
nlohmann::json makeSummary(const Scenario& scenario, const VirtualRun& run) {
  const RunSummary& s = run.summary();
  nlohmann::json j;
  j["title"] = scenario.title;
  j["scenario"] = describeScenario(scenario);
  j["scalar"] = sizeof(btScalar) == 8 ? "float64" : "float";
  j["coherency"] = {{"mean_abs", s.coherency_mean}, {"max_abs", s.coherency_max}};
  j["site1"] = describeSite(s.sites[0]);
  j["site2"] = describeSite(s.sites[1]);
  j["scene"]["bodies"] = run.scene().describeBodies();
  j["state_hash"] = fmt::format("{:016x}", s.state_hash);
  j["real_time_factor"] = s.real_time_factor;
  return j;
}

void writeRun(const OutputFolder& folder, const nlohmann::json& summary, const VirtualRun& run) {
  for (int s = 0; s < 2; ++s)
    run.recording(s).writeCsv(folder / fmt::format("site{}.csv", s + 1), run.frame().q_WS);
  run.scene().writeCsv(folder / "scene.csv");
  writeText(folder / "summary.json", summary.dump(2) + "\n");
  folder.publish("summary.json", {"site1.json", "site2.json", "scene1.csv", "scene2.csv"});
}

}  // namespace tandem::demos
