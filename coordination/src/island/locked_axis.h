#pragma once

namespace tandem {

/// True if factors lock a direction: an impulse along it would be huge. It moves less than this
/// share of free bodies of the same masses: it is within 6 degrees of the locked axis.
/// `mobility`: speed per impulse along it, `free_mobility`: without factors [1/kg].
[[nodiscard]] inline bool isLocked(double mobility, double free_mobility) noexcept {
  constexpr double kLocked = 0.01;
  return mobility < kLocked * free_mobility;
}

}  // namespace tandem
