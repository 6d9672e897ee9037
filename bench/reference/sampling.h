#pragma once

#include <cstdint>

namespace tandem::reference {

/// Motion of the haptic interface point (HIP) between two samples of its device.
///
/// The device holds the force of its tick in both. Only the HIP that other bodies touch differs.
enum class HipMotion {
  kExtrapolated,  ///< p + v tau, with p and v sampled tau seconds ago at the last tick
  kContinuous,    ///< the device's own position, the limit of infinitely fast sampling
};

/// Rates and delay of the two sites, which share one clock.
struct Sampling {
  double haptic_rate = 1000.0;  ///< ticks per second [Hz]; tick k is at k / haptic_rate
  double packet_rate = 128.0;   ///< packets per second [Hz]; packet n leaves at n / packet_rate
  double delay = 0.05;          ///< one way, both directions [s]
  double duration = 1.0;        ///< [s], a whole number of haptic periods
};

/// An instant with a sample. All its events happen in the order of the fields.
struct Instant {
  double t = 0.0;         ///< [s]
  bool sends = false;     ///< each site sends its state to the other
  bool receives = false;  ///< each site receives the oldest packet under way
  bool ticks = false;     ///< each site samples its device and renders a new force
  bool ends = false;      ///< t is the duration; no tick follows
};

/// Gives the instants of a run one after the other, each at its exact time.
///
/// An integrator that steps from one instant to the next never has an event inside a step. The
/// constructor throws std::invalid_argument in three cases: rates or duration are not positive, the
/// delay is negative, or the duration is no whole number of haptic periods.
class SampleClock {
 public:
  explicit SampleClock(const Sampling& sampling);

  /// The next instant. The last one is marked `ends`; do not ask again after it.
  [[nodiscard]] Instant next();

 private:
  Sampling sampling_;
  std::int64_t tick_count_;
  std::int64_t next_tick_ = 0;
  std::int64_t next_sent_ = 0;
  std::int64_t next_received_ = 0;
};

/// Number of equal steps, each no longer than `max_step`, that make up `duration`; at least one.
[[nodiscard]] int countSteps(double duration, double max_step);

}  // namespace tandem::reference
