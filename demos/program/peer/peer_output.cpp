#include "peer/peer_output.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "world/site_summary.h"

namespace tandem::demos {
namespace {

nlohmann::json summariseOwnSite(const Scenario& scenario, int number, PeerRun& run) {
  const Site& site = run.world().site();
  SiteSummary summary = summariseSite(site, run.recording());
  summary.received_mean = run.receivedMean();
  const SceneFrame frame = makeSceneFrame(scenario);
  const Vec3 moved_W = site.hip().p_W - computeStart(scenario, frame, number - 1);
  summary.device_end = frame.toScene(moved_W).x();
  return describeSite(summary);
}

nlohmann::json summariseNetwork(const PeerRun& run) {
  const PeerStatus peer = run.peerStatus();
  nlohmann::json refused = nlohmann::json::object();
  for (const RefusedDatagrams& one : run.peers().refused()) refused[one.reason] = one.count;
  return {{"round_trip", peer.round_trip},
          {"clock_offset", peer.clock_offset},
          {"playout_wait", peer.wait},
          {"jitter", peer.jitter},
          {"loss", peer.loss},
          {"states",
           {{"sent", peer.states_sent},
            {"unsent", peer.states_unsent},
            {"given", peer.states_given},
            {"stale", peer.states_stale},
            {"too_late", peer.states_too_late}}},
          {"datagrams", {{"received", run.peers().received()}, {"refused", refused}}}};
}

}  // namespace

nlohmann::json makePeerSummary(const Scenario& scenario, int site, PeerRun& run) {
  const LoopReport& loop = run.loop();
  nlohmann::json j;
  j["title"] = scenario.title;
  j["scenario"] = describeScenario(scenario);
  j["scalar"] = sizeof(btScalar) == 8 ? "float64" : "float";
  j[fmt::format("site{}", site)] = summariseOwnSite(scenario, site, run);
  j["network"] = summariseNetwork(run);
  j["loop"] = {
      {"ticks", loop.ticks},
      {"late", loop.late},
      {"skipped", loop.skipped},
      {"worst_lateness", loop.late_max},
      {"lateness", {{"p50", loop.late_p50}, {"p99", loop.late_p99}}},
      {"tick_time", {{"p50", loop.tick_p50}, {"p99", loop.tick_p99}, {"max", loop.tick_max}}}};
  return j;
}

void writePeerRun(const OutputFolder& folder, int site, const nlohmann::json& summary,
                  const PeerRun& run) {
  const std::string name = fmt::format("site{}", site);
  run.recording().writeCsv(folder / (name + ".csv"), makeSceneFrame(run.scenario()).q_WS);
  writeText(folder / (name + ".json"), summary.dump(2) + "\n");
  folder.publish(name + ".json", {"summary.json"});
}

void printPeerSummary(const nlohmann::json& summary, int site) {
  const nlohmann::json& own = summary[fmt::format("site{}", site)];
  const nlohmann::json& loop = summary["loop"];
  fmt::print("force, mean / largest            {:>12.3f} / {:.3f} N\n",
             own["force"]["mean"].get<double>(), own["force"]["max"].get<double>());
  fmt::print("contact changes, device end      {:>12} , {:.4f} m\n",
             own["contact_transitions"].get<int>(), own["device_end"].get<double>());
  fmt::print("ticks, late, skipped, worst      {:>12} , {} , {} , {:.2f} ms\n",
             loop["ticks"].get<std::uint64_t>(), loop["late"].get<std::uint64_t>(),
             loop["skipped"].get<std::uint64_t>(), 1e3 * loop["worst_lateness"].get<double>());
  fmt::print("length of a tick, median / p99   {:>12.1f} / {:.1f} us\n",
             1e6 * loop["tick_time"]["p50"].get<double>(),
             1e6 * loop["tick_time"]["p99"].get<double>());
  for (const auto& [reason, count] : summary["network"]["datagrams"]["refused"].items())
    fmt::print("refused datagrams, {:<13} {:>12}\n", reason, count.get<std::uint64_t>());
}

}  // namespace tandem::demos
