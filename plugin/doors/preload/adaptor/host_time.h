#pragma once

#include <cstdint>

namespace tandem::preload {

/// Simulated time of a host [s], counted in equal steps instead of summed.
class HostTime {
 public:
  /// Takes the arguments and the result of stepSimulation().
  void advance(double dt, int max_sub_steps, double fixed_step, int sub_steps) noexcept {
    // Without sub-steps Bullet makes one step of dt.
    if (max_sub_steps == 0) {
      add(dt, 1);
    } else {
      add(fixed_step, sub_steps < max_sub_steps ? sub_steps : max_sub_steps);
    }
  }
  [[nodiscard]] double now() const noexcept {
    return before_ + static_cast<double>(count_) * step_;
  }

 private:
  void add(double step, int count) noexcept {
    if (step != step_) {
      before_ = now();
      step_ = step;
      count_ = 0;
    }
    count_ += static_cast<std::uint64_t>(count);
  }

  double before_ = 0.0, step_ = 0.0;
  std::uint64_t count_ = 0;
};

}  // namespace tandem::preload
