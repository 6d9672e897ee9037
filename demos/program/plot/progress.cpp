#include "plot/progress.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace tandem::demos::plot {

Progress::Progress(std::size_t steps)
    : steps_(steps),
      is_terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {}

Progress::~Progress() {
  if (is_terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::begin(std::string_view what) {
  ++begun_;
  if (!is_terminal_) return;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const auto done = static_cast<double>(begun_ - 1);
  const double remaining = begun_ > 1 ? elapsed / done * (static_cast<double>(steps_) - done) : 0.0;
  fmt::print(stderr, "\r\033[Kfigure {} of {}: {}  {:.0f} s", begun_, steps_, what, elapsed);
  if (begun_ > 1) fmt::print(stderr, ", about {:.0f} s left", remaining);
  std::fflush(stderr);
}

}  // namespace tandem::demos::plot
