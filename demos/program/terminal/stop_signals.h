#pragma once

#include <array>

#include <signal.h>

namespace tandem::demos {

/// While it lives, SIGINT, SIGTERM and, unless ignored, SIGHUP ask to stop instead of ending the
/// program. They arrive only in a wait with whileWaiting() as signal mask (ppoll), so none is
/// missed between check and wait. One at a time; make it in the main thread, before other threads
/// start.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] bool isAsked() const noexcept;
  /// Waits for `seconds`. Returns true, at once, if asked to stop.
  [[nodiscard]] bool isAskedWithin(double seconds) const noexcept;
  [[nodiscard]] const sigset_t& whileWaiting() const noexcept { return before_; }

 private:
  sigset_t before_{};
  std::array<struct sigaction, 3> actions_before_{};
};

}  // namespace tandem::demos
