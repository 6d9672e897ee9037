#pragma once

#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// Real-time rights of a thread, as far as the system grants them. They end with the thread and
/// with this object. Locked memory stays locked, because other threads may rely on it.
class RealtimeRights {
 public:
  RealtimeRights() = default;
  ~RealtimeRights();
  RealtimeRights(const RealtimeRights&) = delete;
  RealtimeRights& operator=(const RealtimeRights&) = delete;

  /// Acts on the calling thread. Sets SCHED_FIFO at `priority` (0: unchanged), locks the process's
  /// memory, touches the stack and keeps the processor out of deep sleep.
  void take(int priority, bool locks_memory) noexcept;

  /// Rights that were not granted, with the remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::vector<std::string> notes_;
  int wakefulness_ = -1;
};

}  // namespace tandem
#pragma GCC visibility pop
