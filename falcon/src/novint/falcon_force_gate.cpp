#include "novint/falcon_force_gate.h"

#include <algorithm>

#include "coordination/src/force_rise.h"
#include "guard/force_limit.h"

namespace tandem {
namespace {

/// Longest step of the slew limit [s]: pauses do not allow a larger jump afterwards.
constexpr double kLongestStep = 0.001;

using falcon_detail::shorten;

}  // namespace

void FalconForceGate::clear() noexcept {
  force_.setZero();
  was_open_ = false;
}

double FalconForceGate::computeShare(double age, double now) const noexcept {
  if (!(age < limits_.hold + limits_.fade)) return 0.0;
  double share = 1.0;
  if (age > limits_.hold) share = 1.0 - (age - limits_.hold) / limits_.fade;
  if (limits_.ramp_in > 0.0) share *= std::clamp((now - opened_at_) / limits_.ramp_in, 0.0, 1.0);
  return share;
}

Vec3 FalconForceGate::advance(const Vec3& wanted, double age, bool is_open, double now) noexcept {
  if (is_open && !was_open_) opened_at_ = now;
  was_open_ = is_open;
  const bool must_go = !is_open || !(age <= limits_.hold) || !wanted.allFinite();
  const double share = is_open && wanted.allFinite() ? computeShare(age, now) : 0.0;
  const Vec3 target =
      share > 0.0 ? Vec3(share * shorten(wanted, limits_.max_force)) : Vec3(Vec3::Zero());
  const double step = std::clamp(now - last_, 0.0, kLongestStep);
  last_ = now;
  if (share < 1.0) {  // the gate lowers the force, not its caller
    const double slowest = must_go ? limits_.max_force / kLongestForceFade : 0.0;
    force_ += shorten(target - force_, std::max(limits_.max_slew, slowest) * step);
  } else {
    force_ = riseTowards(target, force_, limits_.max_slew * step);
  }
  return force_;
}

}  // namespace tandem
