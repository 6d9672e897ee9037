#pragma once

#include <chrono>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>
#include <unistd.h>

namespace tandem::demos::bench {

/// One line on stderr that is written over and over; silent when stderr is not a terminal.
class ProgressLine {
 public:
  ProgressLine() = default;
  ~ProgressLine() {
    if (is_terminal_) std::fputs("\r\033[K", stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// What is being done and the share of the work that is done, 0 to 1.
  void show(std::string_view what, double share) const {
    if (!is_terminal_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    fmt::print(stderr, "\r\033[K{:3.0f} %  {}  {:.0f} s", 100.0 * share, what, elapsed.count());
    if (share > 0.02)
      fmt::print(stderr, ", about {:.0f} s left", elapsed.count() * (1.0 / share - 1.0));
    std::fflush(stderr);
  }

 private:
  bool is_terminal_ = isatty(STDERR_FILENO) == 1;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tandem::demos::bench
