#include "site/timeline.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Rotation vector of a rotation [rad].
Vec3 toVector(const Quat& q) noexcept {
  const double s = q.vec().norm();
  // Near no rotation the quotient goes to 2.
  if (s < 1e-9) return std::copysign(2.0, q.w()) * q.vec();
  return 2.0 * std::atan2(std::copysign(s, q.w()), std::abs(q.w())) / s * q.vec();
}

Quat toRotation(const Vec3& vector) noexcept {
  const double angle = vector.norm();
  if (angle < 1e-12) return Quat(1.0, 0.5 * vector.x(), 0.5 * vector.y(), 0.5 * vector.z());
  const Vec3 part = std::sin(0.5 * angle) / angle * vector;
  return Quat(std::cos(0.5 * angle), part.x(), part.y(), part.z());
}

/// Cubic Hermite interpolation between two states h apart [s]. The relative error is about w^4 h^4
/// / 384.
RigidState interpolate(const RigidState& a, double a_time, const RigidState& b, double b_time,
                       double time) noexcept {
  const double h = b_time - a_time;
  if (!(h > 0.0)) return b;
  const double s = (time - a_time) / h, s2 = s * s, s3 = s2 * s;
  const double from_a = s3 - 2 * s2 + s, from_b = s3 - s2;  // weights of rates
  RigidState state;
  state.p_W = (2 * s3 - 3 * s2 + 1) * a.p_W + from_a * h * a.v_W + (3 * s2 - 2 * s3) * b.p_W +
              from_b * h * b.v_W;
  state.v_W = (6 * s2 - 6 * s) / h * (a.p_W - b.p_W) + (3 * s2 - 4 * s + 1) * a.v_W +
              (3 * s2 - 2 * s) * b.v_W;
  // A steady turn from a to b, and a cubic for what the rates differ from it.
  const Vec3 turn_W = toVector(b.q_WB * a.q_WB.conjugate()), mean_W = turn_W / h;
  const Vec3 more_a_W = a.w_W - mean_W, more_b_W = b.w_W - mean_W;
  const Quat beside_W = toRotation(h * (from_a * more_a_W + from_b * more_b_W));
  state.q_WB = (beside_W * toRotation(s * turn_W) * a.q_WB).normalized();
  state.w_W = beside_W * mean_W + (3 * s2 - 4 * s + 1) * more_a_W + (3 * s2 - 2 * s) * more_b_W;
  return state;
}

}  // namespace

RigidState computeStart(RigidState end, double dt) noexcept {
  end.p_W -= dt * end.v_W;
  end.q_WB = (toRotation(-dt * end.w_W) * end.q_WB).normalized();
  return end;
}

Timeline::Timeline(Island& island, double period, double host_step) noexcept
    : island_(island),
      period_(period),
      host_step_(host_step),
      step_end_(host_step > 0.0 ? host_step : kNever) {}

void Timeline::setBodyCount(std::size_t count) {
  const std::size_t count_before = start_states_.size();
  snapshots_.setBodyCount(count);
  start_states_.resize(count);
  for (std::size_t b = count_before; b < count; ++b) {
    const auto body = static_cast<BodyIndex>(b);
    enter(body, island_.state(body));
  }
  moved_.reserve(count);
  start_rest_.clear();
  snapshot_rest_.clear();
}

void Timeline::begin(double now, double host_shift) noexcept {
  start_ = time_ = now;
  step_end_ += host_shift;
  keepStates(now, now);
}

void Timeline::keepStart() noexcept {
  if (start_rest_.holds(island_)) return;
  // A body that fell asleep in the last tick has moved in it, too.
  const std::vector<BodyIndex>& awake = island_.awakeBodies();
  for (const BodyIndex b : moved_) setStart(b, island_.state(b));
  for (const BodyIndex b : awake) setStart(b, island_.state(b));
  moved_.assign(awake.begin(), awake.end());
  start_rest_.set(island_);
}

void Timeline::moveTo(double until) noexcept {
  if (until - time_ > kSameTime) {
    island_.advance(std::min(until - time_, period_));
    time_ = until;
  }
  if (step_end_ > time_ + kSameTime) return;
  keepStates(step_end_, step_end_);
  island_.cutContacts(host_step_);
  step_end_ = host_step_ > 0.0 ? step_end_ + host_step_ : kNever;
}

void Timeline::lose(double until) noexcept {
  if (!island_.isAsleep()) keepStates(time_, until);
  time_ = tick_start_ = until;
  keepStart();
  if (host_step_ > 0.0 && step_end_ < until)
    step_end_ += std::ceil((until - step_end_) / host_step_) * host_step_;
}

void Timeline::announce(double end, double step) noexcept {
  host_step_ = step;
  if (time_ < end) step_end_ = end;
}

void Timeline::announceAfterNow(double end, double step) noexcept {
  host_step_ = step;
  step_end_ = end;
  constexpr double kManySteps = 1000.0;
  if (time_ - step_end_ > kManySteps * step)
    step_end_ += std::floor((time_ - step_end_) / step) * step;
  while (step_end_ <= time_)
    step_end_ = std::max(step_end_ + step, std::nextafter(step_end_, kNever));
}

void Timeline::put(BodyIndex body, const RigidState& state) noexcept {
  island_.setState(body, state);
  changeKeptAfter(start_ - period_, body, [&](const RigidState&, double kept) {
    return computeStart(state, time_ - kept);
  });
  setStart(body, computeStart(state, time_ - tick_start_));
}

void Timeline::keepStates(double since, double time) noexcept {
  const auto copy = [&](std::vector<RigidState>& states) {
    for (std::size_t b = 0; b < states.size(); ++b)
      states[b] = island_.state(static_cast<BodyIndex>(b));
  };
  if (!island_.isAsleep()) return copy(snapshots_.add(time, since));
  if (!snapshot_rest_.holds(island_)) {
    copy(snapshots_.startRest());
    snapshot_rest_.set(island_);
  }
  snapshots_.addRest(time);
}

RigidState Timeline::stateAt(BodyIndex body, double time) noexcept {
  const RigidState& now = island_.state(body);
  if (time >= time_) return now;
  const auto place = static_cast<std::size_t>(body);
  const RigidState& start = start_states_[place];
  if (time >= tick_start_) return interpolate(start, tick_start_, now, time_, time);
  const Snapshots::Moment from = snapshots_.latestUntil(time), to = snapshots_.earliestAfter(time);
  const bool is_kept = to.states && (to.time < tick_start_ || to.since < to.time);
  const RigidState& after = is_kept ? (*to.states)[place] : start;
  const double end = is_kept ? to.since : tick_start_;
  if (time >= end) return after;
  if (from.states) return interpolate((*from.states)[place], from.time, after, end, time);
  return computeStart(after, std::min(end - time, period_));
}

void Timeline::readStates(double time, std::vector<RigidState>& states) noexcept {
  const std::vector<RigidState>* kept = findStates(time);
  for (std::size_t b = 0; b < states.size(); ++b)
    states[b] = kept ? (*kept)[b] : stateAt(static_cast<BodyIndex>(b), time);
}

}  // namespace tandem
