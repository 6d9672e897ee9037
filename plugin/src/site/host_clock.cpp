#include "site/host_clock.h"

#include <cmath>

namespace tandem {
namespace {

/// A host that is later than this, besides its stall, has dropped the time [s].
constexpr double kLostTime = 0.5;

/// A live host's clock is advanced by the least lateness within this time [s].
constexpr double kWatch = 1.0;

/// The lateness of the host's forces falls by this much per second of host time [s/s].
constexpr double kLatenessDecay = 0.02;

}  // namespace

void HostClock::follow(double island_time, double dt) noexcept {
  const double late = island_time - (time_ + dt);
  if (late <= kLostTime + stall_) return;
  time_ += late;
  ++times_set_;
}

void HostClock::followLive(double island_time, double dt, double kept, double period) noexcept {
  const double late = island_time - (time_ + dt);
  has_jumped_ = late > kept;
  if (late < 0.0 || has_jumped_) time_ += late;
  least_late_ = has_jumped_ ? 0.0 : std::min(least_late_, std::max(late, 0.0));
  watched_ += dt;
  const bool is_over = watched_ >= kWatch;
  const bool is_set_on = is_over && least_late_ > period;
  if (is_set_on) time_ += least_late_;
  times_set_ += has_jumped_ || is_set_on;
  if (!is_over) return;
  least_late_ = kNever;
  watched_ = 0.0;
}

void HostClock::watchLateness(double island_time, double dt, double period) noexcept {
  const double beyond_tick = std::max(0.0, island_time - (time_ + dt) - period);
  lateness_ = std::max(beyond_tick, lateness_ - kLatenessDecay * dt);
}

}  // namespace tandem
