#include "device/exchange.h"

#include <algorithm>
#include <cmath>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::demos {
namespace {

constexpr double kPeriod = 1e-3;  // [s]

}  // namespace

bool exchange(LiveDevice& device, double duration, const Pause& pause, const MakeForce& make_force,
              std::vector<double>* lateness) {
  const double begin = readMonotonicClock();
  const double ticks = std::ceil(duration / kPeriod);
  for (double tick = 0.0; tick < ticks; ++tick) {
    sleepUntil(begin + tick * kPeriod);
    if (pause(0.0)) return false;
    const double t = readMonotonicClock() - begin;
    if (lateness) lateness->push_back(t - tick * kPeriod);
    device.write(make_force(t, device.read(t)));
    tick = std::max(tick, std::floor((readMonotonicClock() - begin) / kPeriod));
  }
  return true;
}

}  // namespace tandem::demos
