#include "novint/falcon_tracker.h"

#include <algorithm>

#include "novint/arm_range.h"

namespace tandem {
namespace {

constexpr double kSlack = 0.0005;         // allowance for encoder steps and bunched replies [m]
constexpr double kLongestReach = 0.005;   // longest gap that enlarges the accepted distance [s]
constexpr double kShortestStep = 0.0005;  // shortest step for a velocity [s]

Vec3 anglesOf(const std::array<std::int16_t, 3>& counts) noexcept {
  return {angleOfCounts(counts[0]), angleOfCounts(counts[1]), angleOfCounts(counts[2])};
}

}  // namespace

void FalconTracker::forget(double now) noexcept {
  pose_.reset();
  doubted_D_.reset();
  stop();
  at_ = now;
}

void FalconTracker::stop() noexcept {
  count_rates_.clear();
  v_D_.setZero();
}

FalconTracker::Outcome FalconTracker::take(const std::array<std::int16_t, 3>& counts,
                                           double now) noexcept {
  const Vec3 angles = anglesOf(counts);
  if (!falcon_detail::areInRange(angles)) return Outcome::kNone;
  const auto pose = pose_ ? kinematics_.computePoseOfAngles(angles, pose_->p_D)
                          : kinematics_.computePoseOfAngles(angles);
  if (!pose) return Outcome::kNone;
  const double elapsed = now - at_;
  const double reach = fastest_hand_ * std::min(elapsed, kLongestReach) + kSlack;
  const auto isNear = [&](const Vec3& p_D) { return (pose->p_D - p_D).norm() <= reach; };

  Outcome outcome = Outcome::kMoved;
  if (pose_ && isNear(pose_->p_D)) {
    if (elapsed < kShortestStep) return outcome;  // of bunched replies the first one counts
  } else if (pose_ && !(doubted_D_ && isNear(*doubted_D_))) {
    if (!doubted_D_) ++jumps_;
    doubted_D_ = pose->p_D;
    return Outcome::kNone;
  } else {
    outcome = Outcome::kPlaced;
    stop();
  }
  const Vec3 counted(counts[0], counts[1], counts[2]);
  const Vec3 angle_rates = angleRatesOfCounts(count_rates_.add(now, counted));
  v_D_ = computeVelocity(*pose, angle_rates).value_or(Vec3(Vec3::Zero()));
  pose_ = pose;
  doubted_D_.reset();
  at_ = now;
  return outcome;
}

}  // namespace tandem
