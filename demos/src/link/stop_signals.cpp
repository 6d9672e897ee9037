#include "link/stop_signals.h"

namespace tandem::demos {
namespace {

// A handler may touch nothing else.
volatile sig_atomic_t is_asked = 0;

void ask(int) { is_asked = 1; }

}  // namespace

StopSignals::StopSignals() {
  is_asked = 0;
  sigset_t both;
  sigemptyset(&both);
  sigaddset(&both, SIGINT);
  sigaddset(&both, SIGTERM);
  (void)pthread_sigmask(SIG_BLOCK, &both, &before_);
  struct sigaction action {};
  action.sa_handler = ask;
  sigemptyset(&action.sa_mask);
  (void)sigaction(SIGINT, &action, &interrupt_before_);
  (void)sigaction(SIGTERM, &action, &terminate_before_);
  // Whoever started us may have had them blocked.
  sigdelset(&before_, SIGINT);
  sigdelset(&before_, SIGTERM);
}

StopSignals::~StopSignals() {
  (void)sigaction(SIGINT, &interrupt_before_, nullptr);
  (void)sigaction(SIGTERM, &terminate_before_, nullptr);
  (void)pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool StopSignals::isAsked() const noexcept { return is_asked != 0; }

}  // namespace tandem::demos
