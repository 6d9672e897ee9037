#include "watch/motion_history.h"

#include <algorithm>

#include "world/rotation.h"

namespace tandem::view {
namespace {

/// Moved on with its velocities.
RigidState goOn(const RigidState& state, double seconds) {
  RigidState later = state;
  later.p_W += seconds * state.v_W;
  later.q_WB = demos::makeRotation(seconds * state.w_W) * state.q_WB;
  return later;
}

}  // namespace

void MotionHistory::add(double time, const RigidState& state, const ObjectEpoch& epoch) {
  moments_[end_ % kKept] = {time, state, epoch};
  ++end_;
  begin_ = std::max(begin_, end_ - std::min(end_, kKept));
}

void MotionHistory::standUntil(double time) {
  if (begin_ == end_) return;
  begin_ = end_ - 1;
  Moment& newest = moments_[begin_ % kKept];
  newest.time = time;
  newest.state.v_W.setZero();
  newest.state.w_W.setZero();
}

std::optional<RigidState> MotionHistory::at(double time) const {
  if (begin_ == end_) return std::nullopt;
  std::size_t next = end_;
  while (next > begin_ && get(next - 1).time > time) --next;
  if (next == begin_) return get(begin_).state;
  const Moment& last = get(next - 1);
  if (next == end_) return goOn(last.state, std::min(time - last.time, kFarthest));
  return between(last, get(next), time);
}

/// Hermite's cubic.
RigidState MotionHistory::between(const Moment& from, const Moment& to, double time) {
  if (from.epoch != to.epoch) return from.state;
  const double h = std::min(to.time - from.time, kLongest);
  const double s = std::max(0.0, 1.0 - (to.time - time) / h);
  const double r = 1.0 - s;
  RigidState state = from.state;
  state.p_W = r * r * (1.0 + 2.0 * s) * from.state.p_W + s * s * (1.0 + 2.0 * r) * to.state.p_W +
              h * s * r * (r * from.state.v_W - s * to.state.v_W);
  state.q_WB = from.state.q_WB.slerp(s, to.state.q_WB);
  return state;
}

}  // namespace tandem::view
