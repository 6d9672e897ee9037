#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem {

/// Linear and angular momentum about a centre of mass, in W [N s, N m s].
struct Momentum {
  Vec3 linear_W = Vec3::Zero(), angular_W = Vec3::Zero();

  [[nodiscard]] bool isZero() const noexcept {
    return linear_W == Vec3::Zero() && angular_W == Vec3::Zero();
  }
};

[[nodiscard]] inline Momentum operator+(const Momentum& a, const Momentum& b) noexcept {
  return {a.linear_W + b.linear_W, a.angular_W + b.angular_W};
}
[[nodiscard]] inline Momentum operator*(double factor, const Momentum& a) noexcept {
  return {factor * a.linear_W, factor * a.angular_W};
}

/// Share of an impulse `now` that acted in the step `before`, too: a blow does not go on.
[[nodiscard]] inline double computeLastingShare(const Vec3& now, const Vec3& before) noexcept {
  const double common = now.dot(before);
  return common > 0.0 ? std::min(common / now.squaredNorm(), 1.0) : 0.0;
}

}  // namespace tandem
