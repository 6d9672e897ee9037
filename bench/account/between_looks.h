#pragma once

#include <cmath>

#include "tandem/coordination/types.h"

namespace tandem::demos::bench {

/// The smallest rotation from one orientation to another, as a vector in W [rad].
[[nodiscard]] Vec3 computeTurn(const Quat& from, const Quat& to);

/// A body's motion between two states: the cubics in position and rotation that fit both ends.
class BetweenLooks {
 public:
  BetweenLooks(const RigidState& from, const RigidState& to, double dt);

  /// `share` is the part of the time: 0 at the start, 1 at the end.
  [[nodiscard]] RigidState at(double share) const;

 private:
  RigidState from_, to_;
  Vec3 turn_W_;
  double dt_;
};

/// Integral of `f` from 0 to 1 to about `tolerance`, by Simpson's rule. Kinks and jumps of `f` make
/// the parts shorter.
template <typename F>
double integrate(const F& f, double tolerance) {
  constexpr int kMostDepth = 24, kMostParts = 2000;
  int parts_left = kMostParts;
  const auto simpson = [](double first, double middle, double last, double length) {
    return length / 6.0 * (first + 4.0 * middle + last);
  };
  const auto refine = [&](const auto& self, double s, double length, double first, double middle,
                          double last, double whole, int depth) -> double {
    const double quarter = f(s + 0.25 * length), later = f(s + 0.75 * length);
    const double left = simpson(first, quarter, middle, 0.5 * length),
                 right = simpson(middle, later, last, 0.5 * length);
    const double difference = left + right - whole;
    if (depth == kMostDepth || --parts_left < 0 || std::abs(difference) < 15.0 * tolerance)
      return left + right + difference / 15.0;
    return self(self, s, 0.5 * length, first, quarter, middle, left, depth + 1) +
           self(self, s + 0.5 * length, 0.5 * length, middle, later, last, right, depth + 1);
  };
  const double first = f(0.0), middle = f(0.5), last = f(1.0);
  return refine(refine, 0.0, 1.0, first, middle, last, simpson(first, middle, last, 1.0), 0);
}

}  // namespace tandem::demos::bench
