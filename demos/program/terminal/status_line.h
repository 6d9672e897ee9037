#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tandem::demos {

/// A status line. On a terminal it is overwritten at most ten times a second; in a pipe it prints a
/// line a second.
class StatusLine {
 public:
  /// A quiet line prints nothing.
  explicit StatusLine(bool is_quiet, std::FILE* stream = stdout);
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// True if show() would print now; else the caller need not make the text.
  [[nodiscard]] bool isDue() const;
  void show(const std::string& text);
  /// Prints a line that stays.
  void print(const std::string& text);

 private:
  void clear();

  std::FILE* stream_;
  bool is_quiet_, is_terminal_, is_open_ = false;
  double period_, next_ = 0.0;  // [s]
};

/// Progress of a long computation and the time left, on stderr; silent if stderr is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_quiet = false);

  /// Shows the current activity `what` and the finished share of the work, 0 to 1.
  void show(std::string_view what, double share);

 private:
  StatusLine line_;
  double start_;  // [s]
};

}  // namespace tandem::demos
