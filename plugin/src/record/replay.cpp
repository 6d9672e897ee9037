#include "record/replay.h"

namespace tandem {

DeviceSample ReplayDevice::read(double now) noexcept {
  const auto& ticks = recording_.ticks();
  while (next_ < ticks.size() && ticks[next_].time < now) ++next_;
  return next_ < ticks.size() ? ticks[next_].device : DeviceSample{};
}

std::optional<Arrival> ReplayLink::receive(double, double until) noexcept {
  const auto& arrivals = recording_.arrivals();
  while (next_ < arrivals.size() && arrivals[next_].remote != remote_) ++next_;
  if (next_ == arrivals.size() || arrivals[next_].arrival.time >= until) return std::nullopt;
  return arrivals[next_++].arrival;
}

}  // namespace tandem
