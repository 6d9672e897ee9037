#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/falcon/monotonic_clock.h"
#include "tandem/plugin/duration_histogram.h"
#include "tandem/plugin/site.h"

#pragma GCC visibility push(default)
namespace tandem {

struct HapticLoopSettings {
  int priority = 80;         ///< SCHED_FIFO, 1 to 99; 0: keeps the scheduling of the process
  bool locks_memory = true;  ///< true: no tick waits for a page
  /// Time of the first tick on the monotonic clock [s]; empty: at once.
  std::optional<double> begin;
  /// The thread ends by itself after this time, as by stop() [s].
  double duration = std::numeric_limits<double>::infinity();
};

/// Punctuality of a loop. Any thread may read all of it while the loop runs.
struct LoopReport {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;     ///< ticks begun more than half a period late
  std::uint64_t skipped = 0;  ///< ticks left out because their time had passed
  double late_p50 = 0.0, late_p99 = 0.0, late_max = 0.0;  ///< delay of a tick's start [s]
  double tick_p50 = 0.0, tick_p99 = 0.0, tick_max = 0.0;  ///< duration of a tick [s]
  double longest_gap = 0.0;  ///< longest time between the starts of two ticks [s]
  double silence = 0.0;      ///< time since the latest tick began [s]; it grows if the thread hangs
};

/// Haptic thread of a site. It ticks at absolute times of the monotonic clock: k / haptic_rate
/// after the first tick.
///
/// From start to stop this thread alone owns the site's island. The host steps its world from its
/// own thread in real time, at its own 60 to 240 Hz. A host step requests the island and waits to
/// get it between two ticks. It does so once on the way in and once on the way out. Each wait takes
/// at most a period. The haptic thread waits only for its next tick. It takes no lock, allocates
/// nothing and makes no system call but sleep, apart from the device and the links. Use
/// Site::betweenTicks() for everything else about the site.
///
/// A late tick runs at once. Ticks whose whole period has passed are skipped and counted. The next
/// tick advances the island over them, by at most 50 ms; after two gaps in a row it does not. The
/// hand does not feel a host that stands still. When the host continues, its bodies are set to the
/// island's states. A body that the host removes from its world and deletes is ignored from the
/// next host step on. Its mesh, height field or compound must live until then.
class HapticLoop {
 public:
  /// Starts the thread. `site` must hand off (Injection::kHandoff), be ticked by its caller
  /// (TickSource::kCaller) and outlive the loop. Throws std::invalid_argument for settings out of
  /// range, tandem::Error if the system gives no thread.
  explicit HapticLoop(Site& site, const HapticLoopSettings& settings = {});
  /// Calls stop().
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// Fades the force to zero, ends the thread and returns the site to its caller. Not from the
  /// thread itself.
  void stop() noexcept;

  /// False once the thread has released the force and the site.
  [[nodiscard]] bool isRunning() const noexcept;

  /// Rights that the system did not grant, one line each with the remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;

  [[nodiscard]] LoopReport report() const noexcept;
  /// Histograms of the ticks' delays and of their durations.
  [[nodiscard]] const DurationHistogram& lateness() const noexcept;
  [[nodiscard]] const DurationHistogram& tickTimes() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
