#include "peer/peer_output.h"

#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tandem::demos {
namespace {

nlohmann::json summarisePeer(const PeerStatus& peer) {
  return {{"round_trip", peer.round_trip},
          {"clock_offset", peer.clock_offset},
          {"playout_wait", peer.wait},
          {"jitter", peer.jitter},
          {"loss", peer.loss},
          {"is_relayed", peer.is_relayed},
          {"changes_of_way", peer.address_changes},
          {"states",
           {{"sent", peer.states_sent},
            {"unsent", peer.states_unsent},
            {"given", peer.states_given},
            {"stale", peer.states_stale},
            {"too_late", peer.states_too_late}}}};
}

/// The way to each other site has a table of its own, if there are several.
nlohmann::json summariseNetwork(const PeerRun& run) {
  const std::vector<PeerStatus> peers = run.statuses();
  nlohmann::json j;
  if (peers.size() == 1) j = summarisePeer(peers[0]);
  if (peers.size() > 1)
    for (const PeerStatus& peer : peers)
      j[fmt::format("site{}", static_cast<std::uint32_t>(peer.peer))] = summarisePeer(peer);
  nlohmann::json refused = nlohmann::json::object();
  for (const RefusedDatagrams& one : run.peers().refused()) refused[one.reason] = one.count;
  j["datagrams"] = {{"received", run.peers().received()}, {"refused", refused}};
  return j;
}

}  // namespace

nlohmann::json makePeerSummary(const PeerRun& run) {
  nlohmann::json j = run.record().summarise(run.scenario(), run.loop());
  j["network"] = summariseNetwork(run);
  return j;
}

void writePeerRun(const OutputFolder& folder, int site, const nlohmann::json& summary,
                  const PeerRun& run) {
  run.record().write(folder, summary);
  publishSites(folder, site);
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
