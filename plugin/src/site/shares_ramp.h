#pragma once

#include <algorithm>

#include "coordination/src/schemes/coordination_shares.h"

namespace tandem {

/// Leads the shares of couplers and stand-ins to those of another N, evenly over a time. Plain
/// value; real-time safe.
class SharesRamp {
 public:
  /// `length` [s], > 0.
  SharesRamp(const CoordinationShares& start, double length) noexcept
      : from_(start), to_(start), length_(length) {}

  /// Goes from `from` at `now` [s].
  void start(const CoordinationShares& from, const CoordinationShares& to, double now) noexcept {
    from_ = from;
    to_ = to;
    began_ = now;
    is_over_ = false;
  }
  /// The shares at `now`, which must not go back.
  [[nodiscard]] CoordinationShares at(double now) noexcept {
    const double done = std::clamp((now - began_) / length_, 0.0, 1.0);
    is_over_ = done == 1.0;
    if (is_over_) return to_;
    return {from_.object + done * (to_.object - from_.object),
            from_.stand_in + done * (to_.stand_in - from_.stand_in)};
  }
  [[nodiscard]] bool isOver() const noexcept { return is_over_; }

 private:
  CoordinationShares from_, to_;
  double length_, began_ = 0.0;
  bool is_over_ = true;
};

}  // namespace tandem
