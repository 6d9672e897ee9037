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
  int priority = 80;         ///< SCHED_FIFO, 1 to 99; 0: as the process has it
  bool locks_memory = true;  ///< so that no tick waits for a page
  /// Moment of the first tick, of the monotonic clock [s]; nothing: at once.
  std::optional<double> begin;
  /// After so long the thread ends by itself, as by stop() [s].
  double duration = std::numeric_limits<double>::infinity();
};

/// How punctual a loop was. All may be read while it runs, from any thread.
struct LoopReport {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;     ///< of these, begun more than half a period after their moment
  std::uint64_t skipped = 0;  ///< ticks left out because their time had passed before they began
  double late_p50 = 0.0, late_p99 = 0.0,
         late_max = 0.0;  ///< beginning of a tick after its moment [s]
  double tick_p50 = 0.0, tick_p99 = 0.0, tick_max = 0.0;  ///< length of a tick [s]
  double longest_gap = 0.0;  ///< between the beginnings of two ticks [s]
  double silence = 0.0;  ///< since the latest tick began, now [s]: if it grows, the thread hangs
};

/// A site's haptic thread: ticks at absolute moments of the monotonic clock, k / haptic_rate after
/// the first.
///
/// From start to stop the thread alone owns the site's island. The host goes on stepping its world
/// from its own thread, at its own 60 to 240 Hz and in real time: its steps ask for the island,
/// which is given between two ticks, and wait for that: two to four times a step, and up to
/// eight when bodies come and go, each a period at the most. The haptic thread waits for nothing
/// but its next moment. It takes no lock, allocates nothing and makes no system call but to sleep,
/// besides what the device and the links do. Everything else about the site is asked for by
/// Site::betweenTicks().
///
/// A tick that begins late is made at once; ticks whose whole period has passed are skipped and
/// counted, and the next one moves the island over them, 50 ms at the most and not if that tick is
/// the next to be late. A host that stands still is not felt; when it goes on, its bodies are put
/// where they are. A body that the host takes out of its world and deletes is left alone from the
/// next host step on; a mesh, height field or compound of its must live until then.
class HapticLoop {
 public:
  /// Starts the thread. `site` must hand off (Injection::kHandoff), be ticked by its caller
  /// (TickSource::kCaller), and outlive this. Throws std::invalid_argument for settings out of
  /// range, tandem::Error if there is no thread to be had.
  explicit HapticLoop(Site& site, const HapticLoopSettings& settings = {});
  /// As stop().
  ~HapticLoop();
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  /// The force fades to zero, the thread ends, and the site is its caller's again. Not from the
  /// thread itself.
  void stop() noexcept;

  /// False once the thread has let go of the force and the site.
  [[nodiscard]] bool isRunning() const noexcept;

  /// What the system did not grant, one line each with the remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept;

  [[nodiscard]] LoopReport report() const noexcept;
  /// Of the beginnings of ticks after their moments, and of the lengths of ticks.
  [[nodiscard]] const DurationHistogram& lateness() const noexcept;
  [[nodiscard]] const DurationHistogram& tickTimes() const noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem
#pragma GCC visibility pop
