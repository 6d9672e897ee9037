#include <algorithm>
#include <cmath>

#include "island/rigid_step.h"

// What a step does to positions: gaps are closed, and overlap is moved out.

namespace tandem {
namespace {

/// Highest speed at which overlap is moved out [m/s].
constexpr double kMaxShiftSpeed = 0.25;
constexpr int kMaxShiftSweeps = 8;

}  // namespace

void RigidStep::closeGaps(const ContactGroups::Group& group, double h) noexcept {
  gaps_.clear();
  double widest = 0.0;
  for (std::size_t i = 0; i < group.row_count; ++i) {
    const RigidRow& row = *group.rows[i];
    const double distance = row.distance + row.normalShift();
    // moveOutOfOverlap() takes care of what is deeper.
    RigidRow::Local gap{distance < -kSmallGap ? 0.0 : std::min(distance, kSmallGap), 0.0, 0.0};
    if (row.is_anchored && row.mode == RigidRow::Mode::kStick) {
      gap.s = std::clamp(row.slip.s + row.shiftAlong(1), -kSmallGap, kSmallGap);
      gap.t = std::clamp(row.slip.t + row.shiftAlong(2), -kSmallGap, kSmallGap);
    }
    gaps_.push_back(gap);
    if (row.mode != RigidRow::Mode::kOpen)
      widest = std::max({widest, std::abs(gap.n), std::abs(gap.s), std::abs(gap.t)});
  }
  ways_.clear();
  for (std::size_t i = 0; i < group.hold_count; ++i) {
    const JointHold& hold = *group.holds[i];
    const double most = kMaxShiftSpeed * h / hold.reach;
    ways_.push_back(std::clamp(hold.row.way + hold.shifted(), -most, most));
    if (hold.keepsPlace()) widest = std::max(widest, hold.reach * std::abs(ways_.back()));
  }
  if (widest > kClosed) solver_.repair(gaps_, ways_);
}

void RigidStep::moveOutOfOverlap(double h) noexcept {
  for (ContactPoint& point : points_) {
    const double distance = point.row.distance + point.row.normalShift();
    point.aim_distance = std::min(0.0, distance + kMaxShiftSpeed * h);
    point.shift = 0.0;
    // Corners that push and differ by rounding share what is left: closeGaps() has done its best.
    const bool pushes =
        point.row.mode == RigidRow::Mode::kStick || point.row.mode == RigidRow::Mode::kSlide;
    if (pushes && !point.row.is_swept && std::abs(distance) < kSmallGap)
      point.aim_distance = std::min(point.aim_distance, distance);
  }
  for (int sweep = 0; sweep < kMaxShiftSweeps; ++sweep) {
    double most = 0.0;
    for (ContactPoint& point : points_) {
      const double missing = point.aim_distance - point.row.distance - point.row.normalShift();
      const double shift_before = point.shift;
      point.shift = std::max(0.0, shift_before + missing * point.row.inverse_normal);
      const double change = point.shift - shift_before;
      if (change == 0.0) continue;
      point.row.shift({change, 0.0, 0.0});
      most = std::max(most, std::abs(change) / point.row.inverse_normal);
    }
    if (most < kSlop) return;
  }
}

void RigidStep::writeBack(States& after) noexcept {
  for (std::size_t b = 0; b < movers_.size(); ++b) {
    const RigidMover& mover = movers_[b];
    if (!mover.ready) continue;
    RigidState& state = after[b];
    state.v_W = mover.v.toVec3();
    state.w_W = mover.w.toVec3();
    state.p_W += mover.shift.toVec3();
    const Vec3 turn_W = mover.turn.toVec3();
    const double angle = turn_W.norm();
    if (angle > 0.0)
      state.q_WB = (Quat(Eigen::AngleAxisd(angle, turn_W / angle)) * state.q_WB).normalized();
  }
}

}  // namespace tandem
