#include "guard/realtime_rights.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

namespace tandem {
namespace {

/// Touches more stack than a tick needs, so that no tick waits for a page.
void touchStack() noexcept {
  std::array<std::uint8_t, 64 * 1024> stack;
  explicit_bzero(stack.data(), stack.size());
}

}  // namespace

void RealtimeRights::take(int priority, bool locks_memory) noexcept {
  touchStack();
  if (locks_memory) {
    // MCL_ONFAULT: untouched pages need no memory. No MCL_FUTURE: a memory limit would then fail
    // later allocations anywhere in the process.
    if (mlockall(MCL_CURRENT | MCL_ONFAULT) != 0)
      notes_.push_back(std::string("memory is not locked (") + std::strerror(errno) +
                       "): a tick may wait for a page; raise ulimit -l");
  }
  if (priority == 0) return;
  sched_param wanted{};
  wanted.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &wanted) != 0) {
    notes_.push_back(std::string("no real-time priority (") + std::strerror(errno) +
                     "): ticks come late while the machine is busy; give your user rtprio in "
                     "/etc/security/limits.d, or the program CAP_SYS_NICE");
    return;
  }
  // Optional; normally only an administrator may open it.
  wakefulness_ = open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC);
  const std::int32_t none = 0;
  if (wakefulness_ >= 0 && write(wakefulness_, &none, sizeof none) != sizeof none) {
    close(wakefulness_);
    wakefulness_ = -1;
  }
}

RealtimeRights::~RealtimeRights() {
  if (wakefulness_ >= 0) close(wakefulness_);
}

}  // namespace tandem
