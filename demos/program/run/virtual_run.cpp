#include "run/virtual_run.h"

#include <chrono>
#include <cmath>

namespace tandem::demos {
namespace {

/// Largest number of packets that a site can receive in a run, with all duplicates and some room.
std::size_t countArrivals(const Scenario& scenario) {
  const std::size_t remotes = scenario.sites.size() - 1;
  return remotes *
         (static_cast<std::size_t>(2.0 * scenario.duration * scenario.site.packet_rate) + 16);
}

int countProxies(const Site& site) {
  return site.remoteCount() > 0 && site.proxyBody(0) ? site.remoteCount() : 0;
}

}  // namespace

VirtualRun::VirtualRun(const Scenario& scenario)
    : scenario_(scenario),
      frame_(makeSceneFrame(scenario)),
      tick_count_(
          static_cast<std::uint64_t>(std::llround(scenario.duration * scenario.site.haptic_rate))),
      links_(scenario),
      scene_(frame_, scenario.duration) {
  for (int s = 0; s < static_cast<int>(scenario.sites.size()); ++s) addSite(s);
  coherency_.emplace(worlds_);
}

void VirtualRun::addSite(int s) {
  worlds_.push_back(std::make_unique<SiteWorld>(scenario_, s, links_.of(s)));
  Site& site = worlds_.back()->site();
  recordings_.push_back(std::make_unique<Recording>(tick_count_, countArrivals(scenario_),
                                                    site.objectCount(), countProxies(site)));
  site.record(recordings_.back().get());
  scene_.add(s + 1, *worlds_.back());
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
  coherency_->add();
  const double now = static_cast<double>(tick) / scenario_.site.haptic_rate;
  for (auto& world : worlds_) world->site().tick(now);
}

void VirtualRun::checkHealth() {
  for (int s = 0; s < siteCount(); ++s) {
    const std::uint32_t status = world(s).site().status();
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
  coherency_->finish(static_cast<double>(tick_count_));
  summary_.coherency_mean = coherency_->mean();
  summary_.coherency_max = coherency_->max();
  summary_.pairs = coherency_->pairs();
  std::vector<const Recording*> recordings;
  for (const auto& recording : recordings_) recordings.push_back(recording.get());
  summary_.common_motion = computeCommonMotion(recordings, frame_.toWorld(Vec3::UnitX()));
  summary_.state_hash = 0;
  for (int s = siteCount() - 1; s >= 0; --s) {
    summary_.state_hash *= 0x9e3779b97f4a7c15u;
    summary_.state_hash ^= world(s).site().stateHash();
  }
  for (int s = 0; s < siteCount(); ++s) summariseSite(s);
}

void VirtualRun::summariseSite(int s) {
  SiteSummary& site =
      summary_.sites.emplace_back(demos::summariseSite(world(s).site(), recording(s)));
  site.received_mean = coherency_->receivedMean(static_cast<std::size_t>(s));
  const DeviceSample end = world(s).device().read(scenario_.duration);
  site.device_end = frame_.toScene(end.hip.p_W - computeStart(scenario_, frame_, s)).x();
  summary_.felt.push_back(computeFelt(recording(s), scenario_.site.proxy.radius));
}

}  // namespace tandem::demos
