#pragma once

#include <signal.h>

namespace tandem::demos {

/// While it lives, SIGINT and SIGTERM ask to stop instead of ending the program. They come in only
/// while somebody waits with whileWaiting() as signal mask (ppoll), so that none is missed between
/// looking and waiting. One at a time; from the main thread, before others are started.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] bool isAsked() const noexcept;
  [[nodiscard]] const sigset_t& whileWaiting() const noexcept { return before_; }

 private:
  sigset_t before_{};
  struct sigaction interrupt_before_ {};
  struct sigaction terminate_before_ {};
};

}  // namespace tandem::demos
