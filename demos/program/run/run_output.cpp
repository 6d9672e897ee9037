#include "run/run_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

nlohmann::json describeBody(const PlacedSceneBody& placed) {
  const SceneBody& body = placed.body;
  nlohmann::json j = {{"site", placed.site},
                      {"name", body.name},
                      {"role", body.role},
                      {"shape", body.is_box ? "box" : "sphere"},
                      {"motion", body.is_static ? "static" : "dynamic"}};
  if (body.is_box) {
    j["half_extents"] = {body.half_extents.x(), body.half_extents.y(), body.half_extents.z()};
  } else {
    j["radius"] = body.radius;
  }
  return j;
}

std::string makeSceneCsv(const VirtualRun& run) {
  const std::vector<PlacedSceneBody> bodies = run.sceneBodies();
  std::string text = "t,site,body,x,y,z,qw,qx,qy,qz\n";
  for (const SceneFrameRecord& frame : run.frames()) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const RigidState& pose = frame.poses[i];
      fmt::format_to(std::back_inserter(text),
                     "{:.6g},{},{},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}\n", frame.time,
                     bodies[i].site, i, pose.p_W.x(), pose.p_W.y(), pose.p_W.z(), pose.q_WB.w(),
                     pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z());
    }
  }
  return text;
}

}  // namespace

nlohmann::json makeSummary(const Scenario& scenario, const VirtualRun& run) {
  const RunSummary& s = run.summary();
  nlohmann::json j;
  j["title"] = scenario.title;
  j["scenario"] = describeScenario(scenario);
  j["scalar"] = sizeof(btScalar) == 8 ? "float64" : "float";
  j["coherency"] = {{"mean_abs", s.coherency_mean}, {"max_abs", s.coherency_max}};
  j["site1"] = describeSite(s.sites[0]);
  j["site2"] = describeSite(s.sites[1]);
  j["scene"]["bodies"] = nlohmann::json::array();
  for (const PlacedSceneBody& body : run.sceneBodies())
    j["scene"]["bodies"].push_back(describeBody(body));
  j["state_hash"] = fmt::format("{:016x}", s.state_hash);
  j["real_time_factor"] = s.real_time_factor;
  return j;
}

void writeRun(const OutputFolder& folder, const nlohmann::json& summary, const VirtualRun& run) {
  for (int s = 0; s < 2; ++s)
    run.recording(s).writeCsv(folder / fmt::format("site{}.csv", s + 1), run.frame().q_WS);
  writeText(folder / "scene.csv", makeSceneCsv(run));
  writeText(folder / "summary.json", summary.dump(2) + "\n");
  folder.publish("summary.json", {"site1.json", "site2.json"});
}

}  // namespace tandem::demos
