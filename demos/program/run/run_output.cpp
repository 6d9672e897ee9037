#include "run/run_output.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "files/output_folder.h"

namespace tandem::demos {
namespace {

/// A folder for files being written; removed at the end with all files still in it.
class UnfinishedFolder {
 public:
  explicit UnfinishedFolder(const std::filesystem::path& target)
      : target_(target), path_(target / ".tandem-unfinished") {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directory(path_);
  }
  ~UnfinishedFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  UnfinishedFolder(const UnfinishedFolder&) = delete;
  UnfinishedFolder& operator=(const UnfinishedFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  void finish(const std::string& name) const {
    std::filesystem::rename(path_ / name, target_ / name);
  }

 private:
  std::filesystem::path target_, path_;
};

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

void writeRun(const std::filesystem::path& folder, const nlohmann::json& summary,
              const VirtualRun& run) {
  const UnfinishedFolder unfinished(folder);
  for (int s = 0; s < 2; ++s)
    run.recording(s).writeCsv(unfinished / fmt::format("site{}.csv", s + 1), run.frame().q_WS);
  writeText(unfinished / "scene.csv", makeSceneCsv(run));
  writeText(unfinished / "summary.json", summary.dump(2) + "\n");
  // An older run's summary must not belong to the files of this run.
  std::filesystem::remove(folder / "summary.json");
  for (const char* name : {"site1.csv", "site2.csv", "scene.csv", "summary.json"})
    unfinished.finish(name);
}

}  // namespace tandem::demos
