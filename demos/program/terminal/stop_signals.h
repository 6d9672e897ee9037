#pragma once

#include <array>

#include <signal.h>

namespace tandem::demos {

/// While it lives, SIGINT, SIGTERM and, unless it is ignored, SIGHUP ask to stop instead of ending
/// the program. They come in only
/// while somebody waits with whileWaiting() as signal mask (ppoll), so that none is missed between
/// looking and waiting. One at a time; from the main thread, before others are started.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] bool isAsked() const noexcept;
  /// Waits so long [s], and says whether it is asked by then: at once if it is.
  [[nodiscard]] bool isAskedWithin(double seconds) const noexcept;
  [[nodiscard]] const sigset_t& whileWaiting() const noexcept { return before_; }

 private:
  sigset_t before_{};
  std::array<struct sigaction, 3> actions_before_{};
};

}  // namespace tandem::demos
