#pragma once

#include <chrono>

namespace tandem::pybullet {

/// A clock that never runs back [s].
inline double now() {
  const auto since_boot = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since_boot).count();
}

}  // namespace tandem::pybullet
