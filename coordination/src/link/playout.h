#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "tandem/coordination/link.h"
#include "tandem/coordination/playout_settings.h"

#include "link/windowed_minimum.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Turns jitter into constant delay: a state is given when the time since it was sent is that of
/// the fastest packets plus a wait that covers most of the slower ones. Only differences of the
/// sender's clock count, so the clocks need not agree; their drift is followed.
///
///   sent     |    |    |    |
///   arrived       |     |  |      |          lateness: beyond the fastest of the last 2 s
///   given          |    |    |    |          fastest + wait after it was sent
///
/// A packet slower than the wait is given at once, if nothing newer was given before. One that
/// jumped the queue, ahead of the fastest quarter by more than 50 ms and `most`, does not count as
/// the fastest: it waits as long as if it had not. What comes half a second late, as a burst after
/// an outage does, is never applied, unless all has come about equally late for 2 s: then the way
/// has become longer. Pure; real-time safe after construction.
class Playout {
 public:
  enum class Verdict : std::uint8_t {
    kWaits,    ///< or is given at once
    kStale,    ///< something newer was given before
    kTooLate,  ///< beyond max_late
    kFull,     ///< no room; the newest are kept
  };
  struct Counts {
    std::uint64_t given = 0, stale = 0, too_late = 0, full = 0;
  };

  /// Throws std::invalid_argument for settings out of range. Allocates.
  explicit Playout(const PlayoutSettings& settings = {});

  /// A packet sent at `sent` (sender's clock) arrived at `now` [s]; `now` must not run back.
  Verdict push(const StatePacket& packet, double sent, double now) noexcept;

  /// The next packet due before `until`, stamped with the moment it was due, but not before `from`.
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept;

  /// Forgets all: the sender has begun anew.
  void clear() noexcept;

  /// Now kept on top of the fastest packets' delay [s]; 0 if it is off.
  [[nodiscard]] double wait() const noexcept { return settings_.is_on ? wait_ : 0.0; }
  /// Lateness that `quantile` of the recent packets keep [s].
  [[nodiscard]] double jitter() const noexcept { return jitter_; }
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  struct Waiting {
    StatePacket packet;
    double due = 0.0;
  };
  struct LateRun {
    double since = 0.0, least = 0.0, most = 0.0;
    std::uint64_t late = 0, in_time = 0;  ///< packets
  };
  using Remembered = std::array<double, 256>;  ///< of the latest packets

  void learn(double transit, double lateness, double now) noexcept;
  void lookAtRemembered() noexcept;
  [[nodiscard]] double findQuantile(const Remembered& values, double share) noexcept;
  [[nodiscard]] bool isNewRoute(double transit, double now) noexcept;
  void noteInTime() noexcept;
  [[nodiscard]] bool isStale(const StatePacket& packet) const noexcept;

  static constexpr double kWindow = 2.0;      // [s]
  static constexpr double kSettling = 1.0;    ///< the wait is free to jump [s]
  static constexpr std::size_t kRarely = 16;  // packets between two looks at all of them
  static constexpr double kNothing = -std::numeric_limits<double>::infinity();
  static constexpr double kQuarter = 0.25;  // more than that do not jump the queue
  static constexpr double kJump = 0.05;     // [s]; more than clocks part while a quarter comes

  PlayoutSettings settings_;
  WindowedMinimum fastest_{kWindow};
  std::optional<LateRun> late_run_;  ///< of packets that came too late, few of the others between
  Remembered transits_{}, latenesses_{}, sorted_{};
  std::size_t remembered_ = 0;
  double fast_ = kNothing;  ///< transit that a quarter of the remembered keep
  std::uint64_t learnt_ = 0;
  double wait_ = 0.0, jitter_ = 0.0;
  double start_ = 0.0, last_ = 0.0;
  bool has_begun_ = false;
  std::optional<std::uint64_t> given_;  ///< sequence of the newest given
  std::vector<Waiting> waiting_;        ///< capacity settings_.room
  Counts counts_;
};

}  // namespace tandem
#pragma GCC visibility pop
