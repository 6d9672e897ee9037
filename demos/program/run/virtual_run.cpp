#include "run/virtual_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "world/received_object.h"

namespace tandem::demos {
namespace {

/// Largest number of packets that one site can receive in a run, with all duplicates and some room.
std::size_t countArrivals(const Scenario& scenario) {
  return static_cast<std::size_t>(2.0 * scenario.duration * scenario.site.packet_rate) + 16;
}

}  // namespace

VirtualRun::VirtualRun(const Scenario& scenario)
    : scenario_(scenario),
      frame_(makeSceneFrame(scenario)),
      tick_count_(
          static_cast<std::uint64_t>(std::llround(scenario.duration * scenario.site.haptic_rate))),
      scene_(frame_, scenario.duration) {
  const double in_flight =
      (scenario.network.delay + scenario.network.jitter) * scenario.site.packet_rate * 2.0;
  std::tie(ends_[0], ends_[1]) =
      makeSimulatedLinks(scenario.network, static_cast<std::size_t>(in_flight) + 64);
  for (int s = 0; s < 2; ++s) {
    worlds_[s] = std::make_unique<SiteWorld>(scenario, s, *ends_[s]);
    Site& site = worlds_[s]->site();
    recordings_[s] = std::make_unique<Recording>(tick_count_, countArrivals(scenario),
                                                 site.objectCount(), site.proxyBody(0) ? 1 : 0);
    site.record(recordings_[s].get());
    scene_.add(s + 1, *worlds_[s]);
  }
  if (scenario.hasObject()) received_W_.fill(worlds_[0]->site().object(0).p_W);
}

void VirtualRun::run(const std::function<void(double)>& progress) {
  const auto start = std::chrono::steady_clock::now();
  scene_.keep(0.0);
  for (std::uint64_t tick = 0; tick < tick_count_; ++tick) {
    tickAll(tick);
    const double time = static_cast<double>(tick + 1) / scenario_.site.haptic_rate;
    for (auto& world : worlds_) world->stepHostUntil(time);
    if (scene_.isDue(time)) {
      scene_.keep(time);
      checkHealth();
      if (progress) progress(static_cast<double>(tick + 1) / static_cast<double>(tick_count_));
    }
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  summary_.real_time_factor = scenario_.duration / wall.count();
  checkHealth();
  summarise();
}

void VirtualRun::tickAll(std::uint64_t tick) {
  addCoherency();
  const double now = static_cast<double>(tick) / scenario_.site.haptic_rate;
  for (auto& world : worlds_) world->site().tick(now);
}

void VirtualRun::addCoherency() {
  if (!scenario_.hasObject()) return;
  double error = 0.0;
  for (ObjectId id = 0; static_cast<int>(id) < worlds_[0]->site().objectCount(); ++id)
    error = std::max(
        error, (worlds_[0]->site().object(id).p_W - worlds_[1]->site().object(id).p_W).norm());
  summary_.coherency_mean += error;
  summary_.coherency_max = std::max(summary_.coherency_max, error);
  for (std::size_t s = 0; s < 2; ++s) {
    const Site& site = worlds_[s]->site();
    if (const auto received = findObject(site.latest(0), 0)) received_W_[s] = received->p_W;
    summary_.sites[s].received_mean += (site.object(0).p_W - received_W_[s]).norm();
  }
}

void VirtualRun::checkHealth() {
  for (int s = 0; s < 2; ++s) {
    const std::uint32_t status = worlds_[s]->site().status();
    const std::string site = "site " + std::to_string(s + 1) + ": ";
    if (status & kBodyMissing)
      throw Error(site + "a body was taken out of the Bullet world while it was attached");
    if (status & kStateNotFinite)
      throw Error(site + "the motion grew beyond all numbers; lower the gains or raise the masses");
    if (status & kDeviceInvalid)
      throw Error(site + "the hand gave a force or position that is no number");
  }
}

void VirtualRun::summarise() {
  const double ticks = static_cast<double>(tick_count_);
  summary_.coherency_mean /= ticks;
  for (int s = 0; s < 2; ++s) {
    SiteSummary& site = summary_.sites[s];
    const double received_mean = site.received_mean / ticks;
    site = summariseSite(worlds_[s]->site(), *recordings_[s]);
    site.received_mean = received_mean;
    const Vec3 start_W = computeStart(scenario_, frame_, s);
    const DeviceSample end = worlds_[s]->device().read(scenario_.duration);
    site.device_end = frame_.toScene(end.hip.p_W - start_W).x();
  }
  summary_.state_hash =
      worlds_[0]->site().stateHash() ^ (worlds_[1]->site().stateHash() * 0x9e3779b97f4a7c15u);
}

}  // namespace tandem::demos
