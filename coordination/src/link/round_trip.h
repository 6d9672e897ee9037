#pragma once

#include "link/windowed_minimum.h"

#pragma GCC visibility push(default)
namespace tandem {

// clang-format off
/// Round trip and clock offset to a peer, from time stamps that travel there and back:
///
///   own clock      t0 ------------------------ t3         round trip  (t3 - t0) - (t2 - t1)
///                    \                        /           offset      ((t1 - t0) + (t2 - t3)) / 2
///   peer's clock      t1 ------ held ------ t2
///
/// The offset comes from the fastest trips of the last 10 s. It is exact if both ways take equally
/// long. The error is half the difference of the two ways; without a third clock it is unknown.
/// Pure; real-time safe.
// clang-format on
class RoundTrip {
 public:
  /// Adds a datagram sent at `t0` that came back at `t3` (own clock). The peer held it for `hold`
  /// [s] and answered at `t2` (its clock). Negative trips and non-finite numbers are ignored.
  void add(double t0, double t2, double hold, double t3) noexcept;

  [[nodiscard]] bool isKnown() const noexcept { return is_known_; }
  /// Smoothed round trip [s]; 0 before the first.
  [[nodiscard]] double trip() const noexcept { return trip_; }
  /// The fastest round trip of the last 10 s [s].
  [[nodiscard]] double fastest() const noexcept { return is_known_ ? fastest_.value() : 0.0; }
  /// Peer's clock - own clock [s].
  [[nodiscard]] double offset() const noexcept { return offset_; }

 private:
  static constexpr double kWindow = 10.0;
  WindowedMinimum fastest_{kWindow};
  bool is_known_ = false;
  double trip_ = 0.0;
  double offset_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
