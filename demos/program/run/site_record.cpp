#include "run/site_record.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "run/common_motion.h"
#include "world/received_object.h"
#include "world/site_summary.h"

namespace tandem::demos {
namespace {

Recording makeRecording(const Scenario& scenario, const Site& site, double duration) {
  const auto ticks = static_cast<std::size_t>(std::llround(duration * scenario.site.haptic_rate));
  const auto one = static_cast<std::size_t>(2.0 * duration * scenario.site.packet_rate) + 64;
  const std::size_t arrivals = one * static_cast<std::size_t>(site.remoteCount());
  return {ticks, arrivals, site.objectCount(), site.proxyBody(0) ? site.remoteCount() : 0};
}

nlohmann::json describeLoop(const LoopReport& loop) {
  return {{"ticks", loop.ticks},
          {"late", loop.late},
          {"skipped", loop.skipped},
          {"worst_lateness", loop.late_max},
          {"lateness", {{"p50", loop.late_p50}, {"p99", loop.late_p99}}},
          {"tick_time", {{"p50", loop.tick_p50}, {"p99", loop.tick_p99}, {"max", loop.tick_max}}}};
}

/// A scenario has no hand beside a slot, where a mouse may have left it.
Scenario putHandsIntoSlot(Scenario scenario) {
  if (scenario.guide)
    for (SiteScenario& site : scenario.sites) site.hand.start_offset.tail<2>().setZero();
  return scenario;
}

}  // namespace

SiteRecord::SiteRecord(const Scenario& scenario, int site, SiteWorld& world, double duration)
    : site_(site),
      world_(world),
      frame_(makeSceneFrame(scenario)),
      recording_(makeRecording(scenario, world.site(), duration)),
      scene_(frame_, duration) {
  if (scenario.hasObject()) object_start_W_ = world.site().object(0).p_W;
  scene_.add(site + 1, world);
  world.site().record(&recording_);
}

void SiteRecord::noteStep(double time) {
  if (scene_.isDue(time)) scene_.keep(time);
}

bool SiteRecord::hasAnything() const noexcept {
  return !recording_.ticks().empty() && !scene_.frames().empty();
}

nlohmann::json SiteRecord::summarise(const Scenario& scenario, const LoopReport& loop) const {
  nlohmann::json j;
  j["title"] = scenario.title;
  j["scenario"] = describeScenario(putHandsIntoSlot(scenario));
  j["scalar"] = sizeof(btScalar) == 8 ? "float64" : "float";
  const std::string own = fmt::format("site{}", site_ + 1);
  j[own] = summariseSite(scenario);
  if (scenario.sites.size() > kFewestSites)
    j["contacts"][own] = describeFelt(computeFelt(recording_, scenario.site.proxy.radius),
                                      static_cast<std::size_t>(site_));
  j["loop"] = describeLoop(loop);
  j["scene"]["bodies"] = scene_.describeBodies();
  return j;
}

nlohmann::json SiteRecord::summariseSite(const Scenario& scenario) const {
  const Site& site = world_.site();
  SiteSummary summary = demos::summariseSite(site, recording_);
  summary.received_mean = computeReceivedMean();
  const Vec3 moved_W = site.hip().p_W - computeStart(scenario, frame_, site_);
  summary.device_end = frame_.toScene(moved_W).x();
  return describeSite(summary);
}

/// Mean distance of the own copy to the others' as received [m].
double SiteRecord::computeReceivedMean() const {
  if (recording_.objectCount() == 0 || recording_.ticks().empty()) return 0.0;
  auto next = recording_.arrivals().begin();
  const auto end = recording_.arrivals().end();
  const auto others = static_cast<std::size_t>(world_.site().remoteCount());
  std::vector<std::uint64_t> newest(others);
  std::vector<Vec3> received_W(others, object_start_W_);
  double sum = 0.0;
  for (std::size_t i = 0; i < recording_.ticks().size(); ++i) {
    for (; next != end && next->arrival.time <= recording_.ticks()[i].time; ++next) {
      const StatePacket& packet = next->arrival.packet;
      const auto first = findObject(packet, 0);
      const auto from = static_cast<std::size_t>(next->remote);
      if (packet.sequence < newest[from] || !first) continue;
      newest[from] = packet.sequence;
      received_W[from] = first->p_W;
    }
    for (const Vec3& one_W : received_W) sum += (recording_.object(i, 0).island.p_W - one_W).norm();
  }
  return sum / static_cast<double>(recording_.ticks().size() * others);
}

void SiteRecord::write(const OutputFolder& folder, const nlohmann::json& summary) const {
  recording_.writeCsv(folder / fmt::format("site{}.csv", site_ + 1), frame_.q_WS);
  scene_.writeCsv(folder / fmt::format("scene{}.csv", site_ + 1));
  writeText(folder / fmt::format("site{}.json", site_ + 1), summary.dump(2) + "\n");
}

void publishSites(const OutputFolder& folder, int site) {
  folder.publish(fmt::format("site{}.json", site), {"summary.json", "scene.csv"});
}

}  // namespace tandem::demos
