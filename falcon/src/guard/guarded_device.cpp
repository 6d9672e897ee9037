#include "tandem/falcon/guarded_device.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "coordination/src/force_rise.h"
#include "guard/force_limit.h"
#include "guard/settings_check.h"

namespace tandem {
namespace {

using falcon_detail::require;
using falcon_detail::shorten;

constexpr double kLongestSilence = 0.05;  // longest time between reads, or between writes [s]
constexpr double kLongestFade = 0.03;     // longest time from max_force to zero [s]
constexpr double kMostFadeEnergy = 1e-3;  // most energy that a fade may give the hand [J]
constexpr int kMostStanding = 50;         // reads in a row at the same time
constexpr double kMostCounted = 2e-3;     // most time that a write counts: two haptic periods [s]

}  // namespace

GuardedDevice::GuardedDevice(std::unique_ptr<HapticDevice> device, const GuardSettings& settings)
    : device_(std::move(device)), ramp_(settings.ramp) {
  if (!device_) throw std::invalid_argument("device of the guard is null, give it one");
  require(std::isfinite(settings.max_force) && settings.max_force > 0.0, "max_force of the guard",
          settings.max_force, "finite and above 0 [N]");
  require(std::isfinite(settings.max_slew) && settings.max_slew > 0.0, "max_slew of the guard",
          settings.max_slew, "finite and above 0 [N/s]");
  require(std::isfinite(settings.ramp) && settings.ramp >= 0.0, "ramp of the guard", settings.ramp,
          "finite and at least 0 [s]");
  capabilities_ = device_->capabilities();
  capabilities_.max_force = std::min(settings.max_force, capabilities_.max_force);
  capabilities_.max_slew = std::min(settings.max_slew, capabilities_.max_slew);
  fade_slew_ = std::max(capabilities_.max_slew, capabilities_.max_force / kLongestFade);
  letGo();
}

GuardedDevice::~GuardedDevice() { letGo(); }

DeviceSample GuardedDevice::read(double now) noexcept {
  takeTime(now);
  DeviceSample sample = device_->read(now);
  sample.valid = sample.valid && isFinite(sample.hip) && (!sample.wrist || isFinite(*sample.wrist));
  if (sample.valid) v_W_ = sample.hip.v_W;

  if (is_time_wrong_)
    cut(GuardCut::kTime);
  else if (!sample.valid)
    cut(GuardCut::kNotValid);
  else if (!is_held_.load(std::memory_order_relaxed))
    cut(GuardCut::kDeadMan);
  else if (passed_ > kLongestSilence)
    cut(GuardCut::kLate);
  else if (now_ - last_write_ > kLongestSilence)
    cut(GuardCut::kStale);
  else if (status_.is_cut)
    status_.is_cut = status_.force != Vec3::Zero();  // the ramp begins at zero force
  else
    status_.share = ramp_ > 0.0 ? std::min(1.0, status_.share + passed_ / ramp_) : 1.0;

  if (status_.is_cut) fade();
  return sample;
}

void GuardedDevice::write(const Vec3& f) noexcept {
  last_write_ = now_;
  if (status_.is_cut) return;  // read() already fades the force
  if (!f.allFinite()) {
    cut(GuardCut::kNotFinite);
    fade();
    return;
  }
  Vec3 wanted = shorten(f, capabilities_.max_force);
  if (wanted != f) ++status_.clamped;
  if (status_.share < 1.0 && wanted != Vec3::Zero()) ++status_.ramped;
  wanted *= status_.share;
  const Vec3 force =
      riseTowards(wanted, status_.force, capabilities_.max_slew * std::min(unused_, kMostCounted));
  if (force != wanted) ++status_.slewed;
  send(force);
}

void GuardedDevice::writeTorque(const Vec3& t) noexcept {
  if (!(capabilities_.max_torque > 0.0)) return;
  if (!t.allFinite() && !status_.is_cut) {
    cut(GuardCut::kNotFinite);
    fade();
  }
  device_->writeTorque(status_.is_cut ? Vec3(Vec3::Zero())
                                      : status_.share * shorten(t, capabilities_.max_torque));
}

void GuardedDevice::letGo() noexcept {
  device_->write(Vec3::Zero());
  if (capabilities_.max_torque > 0.0) device_->writeTorque(Vec3::Zero());
}

/// Updates the time available for a change of force, and detects invalid times.
void GuardedDevice::takeTime(double now) noexcept {
  standing_ = now > now_ ? 0 : standing_ + 1;
  is_time_wrong_ = !std::isfinite(now) || (was_read_ && now < now_) || standing_ > kMostStanding;
  if (!std::isfinite(now)) return;
  passed_ = was_read_ && now > now_ ? now - now_ : 0.0;
  unused_ = std::min(unused_ + passed_, std::max(kMostCounted, passed_));
  if (!was_read_ || is_time_wrong_) last_write_ = now;
  now_ = now;
  was_read_ = true;
}

void GuardedDevice::cut(GuardCut reason) noexcept {
  if (!status_.is_cut || reason != reason_) ++status_.cuts[static_cast<std::size_t>(reason)];
  if (!status_.is_cut) fade_energy_ = 0.0;
  status_.is_cut = true;
  status_.share = 0.0;
  if (capabilities_.max_torque > 0.0) device_->writeTorque(Vec3::Zero());
  reason_ = reason;
}

/// A fade is no source of energy either: it ends at once where it would push the hand along.
void GuardedDevice::fade() noexcept {
  fade_energy_ += std::max(0.0, status_.force.dot(v_W_)) * passed_;
  const bool must_end = is_time_wrong_ || fade_energy_ > kMostFadeEnergy;
  const double left = status_.force.norm() - fade_slew_ * unused_;
  send(must_end || left <= 0.0 ? Vec3(Vec3::Zero()) : shorten(status_.force, left));
}

void GuardedDevice::send(const Vec3& force) noexcept {
  status_.force = force;
  unused_ = 0.0;
  device_->write(status_.force);
}

}  // namespace tandem
