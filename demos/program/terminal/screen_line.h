#pragma once

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::demos {

/// What is going on, in one line: on a terminal written over and over, ten times a second; in a
/// pipe a line a second. Prints nothing if it is to be quiet.
class ScreenLine {
 public:
  explicit ScreenLine(bool is_quiet, std::FILE* stream = stdout)
      : stream_(stream),
        is_quiet_(is_quiet),
        is_terminal_(isatty(fileno(stream)) == 1),
        period_(is_terminal_ ? 0.1 : 1.0) {}
  ~ScreenLine() { clear(); }
  ScreenLine(const ScreenLine&) = delete;
  ScreenLine& operator=(const ScreenLine&) = delete;

  /// True if show() would print now: making the text is spared otherwise.
  [[nodiscard]] bool isDue() const { return !is_quiet_ && readMonotonicClock() >= next_; }

  void show(const std::string& text) {
    next_ = readMonotonicClock() + period_;
    // Without wrapping: of a line that is too long for a narrow terminal the rest is not seen.
    fmt::print(stream_, "{}{}{}", is_terminal_ ? "\r\033[?7l" : "", text,
               is_terminal_ ? "\033[K\033[?7h" : "\n");
    is_open_ = is_terminal_;
    std::fflush(stream_);
  }

  /// A line that stays.
  void print(const std::string& text) {
    if (is_quiet_) return;
    clear();
    fmt::print(stream_, "{}\n", text);
    std::fflush(stream_);
  }

 private:
  void clear() {
    if (is_open_) std::fputs("\r\033[K", stream_);
    is_open_ = false;
  }

  std::FILE* stream_;
  bool is_quiet_, is_terminal_, is_open_ = false;
  double period_, next_ = 0.0;
};

}  // namespace tandem::demos
