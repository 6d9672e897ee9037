#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "tandem/coordination/types.h"

namespace tandem {

/// Says how near something is to a user's hand, the rarest told first.
enum class Nearness : std::uint8_t {
  kFar,    ///< seen at most
  kNear,   ///< in the hand's neighbourhood
  kTouch,  ///< touched, or within reach soon
};

/// A sphere that moves: a hand, or the bounding sphere of an object.
struct MovingBall {
  Vec3 p_W = Vec3::Zero();  ///< [m]
  Vec3 v_W = Vec3::Zero();  ///< [m/s]
  double radius = 0.0;      ///< [m]
};

/// The way between two balls that is left soon [m]: the gap between them, less what they approach
/// each other within kForesight. Pure; real-time safe.
[[nodiscard]] inline double computeGapSoon(const MovingBall& a, const MovingBall& b) noexcept {
  constexpr double kForesight = 0.25;  // [s]; longer than a rare packet's period and a usual delay
  const Vec3 way_W = b.p_W - a.p_W;
  const double distance = way_W.norm();
  const double gap = distance - a.radius - b.radius;
  if (distance == 0.0) return gap;
  const double closing = way_W.dot(a.v_W - b.v_W) / distance;
  return gap - kForesight * std::max(closing, 0.0);
}

/// A user's hand and what it holds. Plain value; real-time safe.
struct Reach {
  MovingBall hand;
  std::optional<MovingBall> held;

  /// From the nearer of both [m].
  [[nodiscard]] double computeGapSoon(const MovingBall& other) const noexcept {
    const double gap = tandem::computeGapSoon(hand, other);
    return held ? std::min(gap, tandem::computeGapSoon(*held, other)) : gap;
  }
};

/// Nearness by a gap [m]. What was near stays so up to a wider gap, so that it does not flicker.
/// Pure; real-time safe.
[[nodiscard]] inline Nearness computeNearness(double gap, Nearness before) noexcept {
  constexpr double kReach = 0.03, kNeighbourhood = 0.2;  // [m]
  constexpr double kMargin = 1.3;
  const double touch = before == Nearness::kTouch ? kMargin * kReach : kReach;
  const double near = before == Nearness::kFar ? kNeighbourhood : kMargin * kNeighbourhood;
  if (gap < touch) return Nearness::kTouch;
  return gap < near ? Nearness::kNear : Nearness::kFar;
}

/// Nearness that rises at once, and falls when it has been lower for kCalm. Plain value; real-time
/// safe.
class HeldNearness {
 public:
  static constexpr double kCalm = 0.25;  ///< [s]

  [[nodiscard]] Nearness value() const noexcept { return value_; }

  /// Takes the nearness at `time` [s], which must not go back.
  void update(Nearness now, double time) noexcept {
    if (now < value_ && time - since_ < kCalm) return;
    value_ = now;
    since_ = time;
  }
  /// The same, by a gap [m].
  void update(double gap, double time) noexcept { update(computeNearness(gap, value_), time); }

 private:
  Nearness value_ = Nearness::kFar;
  double since_ = 0.0;  ///< last time at which it was so near [s]
};

}  // namespace tandem
