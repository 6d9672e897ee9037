#include "terminal/stop_signals.h"

#include <cmath>

#include <poll.h>

namespace tandem::demos {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

// A handler may write no other variable.
volatile sig_atomic_t is_asked = 0;

void ask(int) { is_asked = 1; }

}  // namespace

StopSignals::StopSignals() {
  is_asked = 0;
  sigset_t all;
  sigemptyset(&all);
  for (const int number : kSignals) sigaddset(&all, number);
  (void)pthread_sigmask(SIG_BLOCK, &all, &before_);
  struct sigaction action {};
  action.sa_handler = ask;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    (void)sigaction(kSignals[i], &action, &actions_before_[i]);
    // A program under nohup goes on when its terminal closes.
    if (kSignals[i] == SIGHUP && actions_before_[i].sa_handler == SIG_IGN)
      (void)sigaction(SIGHUP, &actions_before_[i], nullptr);
    // The parent process may have blocked them.
    sigdelset(&before_, kSignals[i]);
  }
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i)
    (void)sigaction(kSignals[i], &actions_before_[i], nullptr);
  (void)pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

bool StopSignals::isAsked() const noexcept { return is_asked != 0; }

bool StopSignals::isAskedWithin(double seconds) const noexcept {
  if (isAsked()) return true;
  timespec time{};
  const double whole = std::floor(seconds);
  time.tv_sec = static_cast<time_t>(whole);
  time.tv_nsec = static_cast<long>((seconds - whole) * 1e9);
  (void)ppoll(nullptr, 0, &time, &before_);
  return isAsked();
}

}  // namespace tandem::demos
