#pragma once

#include "link/windowed_minimum.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Round trip and clock offset to a peer, from stamps that go there and come back:
///
///   own clock      t0 ------------------------ t3         round trip  (t3 - t0) - (t2 - t1)
///                    \                        /           offset      ((t1 - t0) + (t2 - t3)) / 2
///   peer's clock      t1 ------ held ------ t2
///
/// The offset is taken from the fastest trips of the last 10 s. It is right if both ways take
/// equally long; without another clock that both sides know nobody can tell more, and the error is
/// half the difference of the two ways. Pure; real-time safe.
class RoundTrip {
 public:
  /// A datagram sent at `t0` came back at `t3` (own clock), after the peer had received it and sent
  /// its answer at `t2` (its clock), holding it for `hold` [s]. Nonsense (a negative trip, numbers
  /// that are not finite) is left out.
  void add(double t0, double t2, double hold, double t3) noexcept;

  [[nodiscard]] bool isKnown() const noexcept { return is_known_; }
  /// Smoothed [s]; 0 before the first.
  [[nodiscard]] double trip() const noexcept { return trip_; }
  /// The fastest of the last 10 s [s].
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
