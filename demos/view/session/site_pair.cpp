#include "session/site_pair.h"

#include <algorithm>
#include <cmath>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::view {
namespace {

/// From the start of the threads to the first tick [s].
constexpr double kGetReady = 0.02;
/// Rounding of times [s].
constexpr double kSameTime = 1e-9;

demos::SiteWorld makeWorld(const demos::Scenario& scenario, int site, Link& link,
                           HapticDevice* device, const demos::BodyPlaces& places) {
  return device ? demos::SiteWorld(scenario, site, link, *device, places)
                : demos::SiteWorld(scenario, site, link, places);
}

}  // namespace

SitePair::SitePair(const demos::Scenario& scenario, const std::array<HapticDevice*, 2>& devices,
                   const demos::BodyPlaces& places)
    : network_(scenario.network),
      own_(makeWorld(scenario, 0, network_.end(0), devices[0], places)),
      other_(makeWorld(scenario, 1, network_.end(1), devices[1], places)),
      haptic_rate_(scenario.site.haptic_rate),
      host_rate_(scenario.host_rate) {}

void SitePair::start() {
  begin_ = readMonotonicClock() + kGetReady - time();
  for (int site : {0, 1}) startLoop(site);
  network_.start(begin_);
}

void SitePair::startLoop(int site) {
  const auto at = static_cast<std::size_t>(site);
  HapticLoopSettings settings;
  settings.begin = begin_ + static_cast<double>(next_ticks_[at]) * period();
  loops_[at] = std::make_unique<HapticLoop>((site == 0 ? own_ : other_).site(), settings);
}

void SitePair::stop() noexcept {
  for (std::size_t site : {0, 1}) {
    if (!loops_[site]) continue;
    loops_[site]->stop();
    const LoopReport& report = reports_[site] = loops_[site]->report();
    next_ticks_[site] += report.ticks + report.skipped;
    loops_[site].reset();
  }
  network_.stop();
}

void SitePair::stepHosts(double time) {
  own_.stepHostUntil(time);
  other_.stepHostUntil(time);
}

double SitePair::time() const noexcept { return static_cast<double>(nextTick()) / haptic_rate_; }

std::uint64_t SitePair::nextTick() const noexcept {
  return std::min(next_ticks_[0], next_ticks_[1]);
}

/// A site whose force took longer to fade waits for the other.
void SitePair::tick() {
  const std::uint64_t tick = nextTick();
  const double now = time();
  network_.carry(now);
  if (next_ticks_[0] == tick) own_.site().tick(now), ++next_ticks_[0];
  if (next_ticks_[1] == tick) other_.site().tick(now), ++next_ticks_[1];
  stepHosts(time());
}

double SitePair::hostStepEnd(int step) const noexcept {
  return (std::floor(time() * host_rate_ + kSameTime) + step) / host_rate_;
}

void SitePair::tickOneHostStep() {
  const double end = hostStepEnd(1);
  while (time() < end - kSameTime) tick();
}

}  // namespace tandem::view
