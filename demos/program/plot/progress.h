#pragma once

#include <chrono>
#include <string_view>

namespace tandem::demos::plot {

/// One line on stderr that says what is being done, how long it took so far and about how long it
/// will take still. Silent when stderr is not a terminal.
class Progress {
 public:
  explicit Progress(std::size_t steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Begins the next of the steps.
  void begin(std::string_view what);

 private:
  std::size_t steps_;
  std::size_t begun_ = 0;
  bool is_terminal_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace tandem::demos::plot
