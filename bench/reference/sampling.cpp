#include "bench/reference/sampling.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tandem::reference {
namespace {

// Instants closer than this are one instant. The sum n / rate + delay and a tick's k / rate are
// rounded differently. A tick must see a packet that arrives at it.
constexpr double kSameInstant = 1e-10;  // [s]

// Allows for the rounding of duration / max_step, so that 1 ms in 2 us steps makes 500 steps.
constexpr double kStepRounding = 1e-6;

}  // namespace

SampleClock::SampleClock(const Sampling& sampling)
    : sampling_(sampling), tick_count_(std::llround(sampling.duration * sampling.haptic_rate)) {
  if (!(sampling.haptic_rate > 0.0) || !(sampling.packet_rate > 0.0)) {
    throw std::invalid_argument("SampleClock: rates must be positive");
  }
  if (!(sampling.delay >= 0.0)) {
    throw std::invalid_argument("SampleClock: delay must not be negative");
  }
  const double end = static_cast<double>(tick_count_) / sampling.haptic_rate;
  if (tick_count_ < 1 || std::abs(end - sampling.duration) > kSameInstant) {
    throw std::invalid_argument("SampleClock: duration must be a whole number of haptic periods");
  }
}

Instant SampleClock::next() {
  const double tick = static_cast<double>(next_tick_) / sampling_.haptic_rate;
  const double departure = static_cast<double>(next_sent_) / sampling_.packet_rate;
  const double arrival =
      static_cast<double>(next_received_) / sampling_.packet_rate + sampling_.delay;

  Instant instant;
  instant.t = std::min({tick, departure, arrival});
  const double due = instant.t + kSameInstant;
  instant.sends = departure <= due;
  instant.receives = arrival <= due;
  instant.ticks = tick <= due && next_tick_ < tick_count_;
  instant.ends = tick <= due && next_tick_ == tick_count_;

  if (instant.sends) ++next_sent_;
  if (instant.receives) ++next_received_;
  if (instant.ticks) ++next_tick_;
  return instant;
}

int countSteps(double duration, double max_step) {
  return std::max(1, static_cast<int>(std::ceil(duration / max_step - kStepRounding)));
}

}  // namespace tandem::reference
