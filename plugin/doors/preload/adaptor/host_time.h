#pragma once

#include <cstdint>

namespace tandem::preload {

/// A host's simulated time [s]: counted in steps of one length, not summed up.
class HostTime {
 public:
  /// As stepSimulation() was told, and what it said that it did.
  void advance(double dt, int max_sub_steps, double fixed_step, int sub_steps) noexcept {
    // Without sub-steps the whole of dt is one step.
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
