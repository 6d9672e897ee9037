#include "terminal/status_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include "tandem/falcon/monotonic_clock.h"

namespace tandem::demos {

StatusLine::StatusLine(bool is_quiet, std::FILE* stream)
    : stream_(stream),
      is_quiet_(is_quiet),
      is_terminal_(isatty(fileno(stream)) == 1),
      period_(is_terminal_ ? 0.1 : 1.0) {}

bool StatusLine::isDue() const { return !is_quiet_ && readMonotonicClock() >= next_; }

void StatusLine::show(const std::string& text) {
  next_ = readMonotonicClock() + period_;
  // A narrow terminal must cut a long line, not wrap it.
  fmt::print(stream_, "{}{}{}", is_terminal_ ? "\r\033[?7l" : "", text,
             is_terminal_ ? "\033[K\033[?7h" : "\n");
  is_open_ = is_terminal_;
  std::fflush(stream_);
}

void StatusLine::print(const std::string& text) {
  if (is_quiet_) return;
  clear();
  fmt::print(stream_, "{}\n", text);
  std::fflush(stream_);
}

void StatusLine::clear() {
  if (is_open_) std::fputs("\r\033[K", stream_);
  is_open_ = false;
}

ProgressLine::ProgressLine(bool is_quiet)
    : line_(is_quiet || isatty(STDERR_FILENO) != 1, stderr), start_(readMonotonicClock()) {}

void ProgressLine::show(std::string_view what, double share) {
  if (!line_.isDue()) return;
  const double elapsed = readMonotonicClock() - start_;  // [s]
  std::string text = fmt::format("{:3.0f} %  {}  {:.0f} s", 100.0 * share, what, elapsed);
  if (share > 0.02) text += fmt::format(", about {:.0f} s left", elapsed * (1.0 / share - 1.0));
  line_.show(text);
}

}  // namespace tandem::demos
