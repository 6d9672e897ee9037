#pragma once

#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// What makes a thread punctual, as far as the system grants it; given back with the thread and
/// with this, but for memory: what was locked stays so, it may be others' too.
class RealtimeRights {
 public:
  RealtimeRights() = default;
  ~RealtimeRights();
  RealtimeRights(const RealtimeRights&) = delete;
  RealtimeRights& operator=(const RealtimeRights&) = delete;

  /// For the calling thread: SCHED_FIFO at `priority` (0: as it is), the process's memory locked,
  /// its stack there, and the processor kept from sleeping deeply.
  void take(int priority, bool locks_memory) noexcept;

  /// What was not granted, with the remedy.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::vector<std::string> notes_;
  int wakefulness_ = -1;
};

}  // namespace tandem
#pragma GCC visibility pop
