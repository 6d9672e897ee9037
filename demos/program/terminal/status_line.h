#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace tandem::demos {

/// One line that says what is going on. On a terminal it is written over and over, at most ten
/// times a second; in a pipe it is a line a second.
class StatusLine {
 public:
  /// A quiet one prints nothing.
  explicit StatusLine(bool is_quiet, std::FILE* stream = stdout);
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  /// True if it is time for the next text; until then nobody need make it.
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

/// How far a long computation has come and how long the rest will take, on stderr; silent if stderr
/// is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool is_quiet = false);

  /// `share` of the work is done, 0 to 1; `what` is being done.
  void show(std::string_view what, double share);

 private:
  StatusLine line_;
  double start_;  // [s]
};

}  // namespace tandem::demos
