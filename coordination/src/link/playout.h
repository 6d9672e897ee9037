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

// clang-format off
/// Turns jitter into constant delay. A state is applied at a fixed time after it was sent: the
/// transit of the fastest packets plus a wait that covers most slower ones. Only differences of the
/// sender's clock count, so the clocks need not agree; their drift is followed.
///
///   sent     |    |    |    |
///   arrived       |     |  |      |          lateness: beyond the fastest of the last 2 s
///   given          |    |    |    |          fastest + wait after it was sent
///
/// A packet slower than the wait is given at once, unless a newer one was given before. A packet
/// that overtook the queue does not count as the fastest: it is ahead of the fastest quarter by
/// more than 50 ms and `most`. It waits as long as the others. A packet over `max_late` late, as in
/// a burst after an outage, is dropped. If all packets are about equally late for 2 s, the route
/// has become longer and they count again. Pure; real-time safe after construction.
// clang-format on
class Playout {
 public:
  enum class Verdict : std::uint8_t {
    kWaits,    ///< the packet waits, or is due at once
    kStale,    ///< a newer packet was given before
    kTooLate,  ///< later than max_late
    kFull,     ///< no room; the newest packets are kept
  };
  struct Counts {
    std::uint64_t given = 0, stale = 0, too_late = 0, full = 0;
  };

  /// Throws std::invalid_argument if a setting is out of range. Allocates.
  explicit Playout(const PlayoutSettings& settings = {});

  /// Adds a packet sent at `sent` (sender's clock) that arrived at `now` [s], which must not go
  /// back.
  Verdict push(const StatePacket& packet, double sent, double now) noexcept;

  /// The next packet due before `until`, stamped with its due time but not before `from`.
  [[nodiscard]] std::optional<Arrival> pop(double from, double until) noexcept;

  /// Forgets everything: the sender has restarted.
  void clear() noexcept;

  /// Present wait on top of the fastest packets' delay [s]; 0 if playout is off.
  [[nodiscard]] double wait() const noexcept { return settings_.is_on ? wait_ : 0.0; }
  /// Lateness that `quantile` of the recent packets do not exceed [s].
  [[nodiscard]] double jitter() const noexcept { return jitter_; }
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  struct Waiting {
    StatePacket packet;
    double due = 0.0;
  };
  struct LateRun {
    double since = 0.0, least = 0.0, most = 0.0;
    std::uint64_t late = 0, in_time = 0;  ///< numbers of packets
  };
  using Remembered = std::array<double, 256>;  ///< values of the latest packets

  void learn(double transit, double lateness, double now) noexcept;
  void lookAtRemembered() noexcept;
  [[nodiscard]] double findQuantile(const Remembered& values, double share) noexcept;
  [[nodiscard]] bool isNewRoute(double transit, double now) noexcept;
  void noteInTime() noexcept;
  [[nodiscard]] bool isStale(const StatePacket& packet) const noexcept;

  static constexpr double kWindow = 2.0;      // [s]
  static constexpr double kSettling = 1.0;    ///< time in which the wait may jump [s]
  static constexpr std::size_t kRarely = 16;  // packets between two sorts of all remembered
  static constexpr double kNothing = -std::numeric_limits<double>::infinity();
  static constexpr double kQuarter = 0.25;  // share of packets that may overtake the queue
  static constexpr double kJump = 0.05;     // [s]; more than clocks drift while a quarter arrives

  PlayoutSettings settings_;
  WindowedMinimum fastest_{kWindow};
  std::optional<LateRun> late_run_;  ///< packets that came too late, with few in time
  Remembered transits_{}, latenesses_{}, sorted_{};
  std::size_t remembered_ = 0;
  double fast_ = kNothing;  ///< transit that a quarter of the remembered packets do not exceed [s]
  std::uint64_t learnt_ = 0;
  double wait_ = 0.0, jitter_ = 0.0;
  double start_ = 0.0, last_ = 0.0;
  bool has_begun_ = false;
  std::optional<std::uint64_t> given_;  ///< sequence number of the newest packet given
  std::vector<Waiting> waiting_;        ///< capacity settings_.room
  Counts counts_;
};

}  // namespace tandem
#pragma GCC visibility pop
