#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem::test {

/// A hand that goes to one drawn place after another, and works against what it feels.
class DrawnHand {
 public:
  explicit DrawnHand(const Vec3& start_W) : at_W_(start_W) {}

  [[nodiscard]] const Vec3& position() const { return at_W_; }
  /// True if it has felt a force.
  [[nodiscard]] bool hasFelt() const { return has_felt_; }

  void aimAt(const Vec3& target_W) { target_W_ = target_W; }
  /// Goes on for `dt` [s] against the force [N] of the last step. Returns its velocity [m/s].
  Vec3 goOn(double dt, const Vec3& felt_W) {
    has_felt_ |= felt_W.norm() > 0.0;
    const Vec3 left = target_W_ - at_W_;
    const Vec3 way = std::min(1.0, kSpeed * dt / std::max(1e-9, left.norm())) * left;
    at_W_ += way;
    work_ = 2.0 * way.norm() * (felt_W.norm() + kForce);
    return way / dt;
  }
  /// Work of the last step, at most [J].
  [[nodiscard]] double work() const { return work_; }

 private:
  static constexpr double kSpeed = 1.0;  // [m/s]
  /// Force that it may begin to feel within a step: it goes 20 mm into a contact [N].
  static constexpr double kForce = 50.0;

  Vec3 at_W_, target_W_ = Vec3::Zero();
  bool has_felt_ = false;
  double work_ = 0.0;
};

}  // namespace tandem::test
