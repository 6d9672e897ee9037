#pragma once

#include <algorithm>

#include "tandem/coordination/types.h"

namespace tandem::falcon_detail {

/// Motion of a cursor that glides in a straight line to each new target. For a glide from c_0 to
/// c_1 that begins at t_0 and takes T:
///
///   c = c_0 + (c_1 - c_0) (t - t_0) / T      c' = (c_1 - c_0) / T      from t_0 to t_0 + T
///   c = c_1                                  c' = 0                    afterwards
///
/// Irregular events thus become a motion without jumps, whose velocity a damper may use.
class CursorGlide {
 public:
  explicit CursorGlide(const Vec3& start_W) noexcept : from_W_(start_W), to_W_(start_W) {}

  /// Begins a new glide at time `t` [s] from where the cursor is then. `duration` [s] is above 0.
  void glideTo(const Vec3& target_W, double t, double duration) noexcept {
    from_W_ = at(t).p_W;
    to_W_ = target_W;
    begin_ = t;
    duration_ = duration;
  }

  /// Position [m] and velocity [m/s] of the cursor at time `t` [s], not before the glide began.
  [[nodiscard]] PointState at(double t) const noexcept {
    const double u = (t - begin_) / duration_;
    if (u >= 1.0) return {to_W_, Vec3::Zero()};
    const Vec3 way = to_W_ - from_W_;
    return {from_W_ + std::max(u, 0.0) * way, way / duration_};
  }

 private:
  Vec3 from_W_, to_W_;
  double begin_ = 0.0, duration_ = 1.0;  ///< [s]
};

}  // namespace tandem::falcon_detail
