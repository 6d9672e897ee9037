#include "tandem/falcon/simulated_device.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "guard/force_limit.h"
#include "guard/settings_check.h"
#include "simulated/damped_mass.h"

// A read interval is cut into sub-steps of length h; the rendered force stays constant:
//
//   last read                                                now
//      |----------|----------|----------|----------|-- ... ---|
//           ^          ^          ^          ^
//           hand's force is evaluated at each middle and held over its sub-step, so that
//           every sub-step is a damped mass under constant force, which has an exact solution
//
// The remaining error is the hand's change within a sub-step, second order in h. For a spring K on
// an undamped mass m the method is symplectic, so no energy is created. Only the frequency w =
// sqrt(K/m) is too high, by the fraction (w h)^2 / 24. That is 2.6e-5 for 1000 N/m and 0.1 kg at 1
// kHz.

namespace tandem {
namespace {

using falcon_detail::DampedMassStep;
using falcon_detail::require;
using falcon_detail::shorten;

constexpr double kUnitTolerance = 1e-6;  // accepts a guide written with seven digits

/// Four sub-steps per haptic period of `interval` [s]. A bound keeps the call short after a long
/// pause.
int countSubsteps(double interval) noexcept {
  constexpr double kPeriod = 1e-3;  // [s]
  constexpr double kMost = 1000.0;  // most periods counted
  constexpr double kSlack = 1e-6;   // rounding must not add a period
  return 4 * static_cast<int>(std::clamp(std::ceil(interval / kPeriod - kSlack), 1.0, kMost));
}

double roundTo(double value, double resolution) noexcept {
  return resolution * std::round(value / resolution);
}

SimulatedDeviceSettings checked(SimulatedDeviceSettings settings) {
  require(std::isfinite(settings.mass) && settings.mass > 0.0, "mass of the simulated device",
          settings.mass, "finite and above 0 [kg]");
  require(std::isfinite(settings.damping) && settings.damping >= 0.0,
          "damping of the simulated device", settings.damping, "finite and at least 0 [N s/m]");
  require(settings.start_W.allFinite(), "start_W of the simulated device", settings.start_W,
          "finite [m]");
  require(std::isfinite(settings.encoder_resolution) && settings.encoder_resolution >= 0.0,
          "encoder_resolution of the simulated device", settings.encoder_resolution,
          "finite and at least 0 [m]; 0 reads exactly");
  require(settings.max_force >= 0.0, "max_force of the simulated device", settings.max_force,
          "at least 0 [N]; infinity means no limit");
  if (settings.guide) {
    const bool is_unit = std::abs(settings.guide->norm() - 1.0) <= kUnitTolerance;
    require(is_unit, "guide of the simulated device", *settings.guide,
            "a unit vector: divide it by its length");
    settings.guide->normalize();
  }
  return settings;
}

}  // namespace

SimulatedDevice::SimulatedDevice(const SimulatedDeviceSettings& settings,
                                 std::unique_ptr<Hand> hand)
    : settings_(checked(settings)), hand_(std::move(hand)) {
  if (!hand_) throw std::invalid_argument("hand of the simulated device is null, give it one");
  capabilities_.name = "simulated";
  capabilities_.max_force = settings_.max_force;
  capabilities_.is_continuous = settings_.encoder_resolution == 0.0;
  handle_ = toWorld(motion_);
}

const DeviceCapabilities& SimulatedDevice::capabilities() const noexcept { return capabilities_; }

DeviceSample SimulatedDevice::read(double now) noexcept {
  const double interval = std::isfinite(now) && now > time_ ? now - time_ : 0.0;
  if (interval > 0.0) {
    advanceHandle(interval);
    time_ = now;
    handle_ = toWorld(motion_);
  }
  if (settings_.encoder_resolution == 0.0) return {handle_, isFinite(handle_)};
  counted_ = encode(interval);
  was_read_ = true;
  const PointState hip = toWorld(counted_);
  return {hip, isFinite(hip)};
}

void SimulatedDevice::write(const Vec3& f_W) noexcept {
  force_W_ = shorten(f_W, settings_.max_force);
}

/// Projects a vector on the free axes: the guide, or W's three.
Vec3 SimulatedDevice::toFree(const Vec3& a_W) const noexcept {
  return settings_.guide ? Vec3(settings_.guide->dot(a_W), 0.0, 0.0) : a_W;
}

Vec3 SimulatedDevice::toWorld(const Vec3& a_free) const noexcept {
  return settings_.guide ? Vec3(a_free.x() * *settings_.guide) : a_free;
}

PointState SimulatedDevice::toWorld(const PointState& motion) const noexcept {
  return {settings_.start_W + toWorld(motion.p_W), toWorld(motion.v_W)};
}

/// Counted position and its first difference. The first read gives zero velocity.
PointState SimulatedDevice::encode(double interval) const noexcept {
  const double resolution = settings_.encoder_resolution;
  const Vec3 counted =
      motion_.p_W.unaryExpr([resolution](double value) { return roundTo(value, resolution); });
  if (!was_read_) return {counted, Vec3::Zero()};
  if (interval == 0.0) return counted_;
  return {counted, (counted - counted_.p_W) / interval};
}

void SimulatedDevice::advanceHandle(double interval) noexcept {
  const int substeps = countSubsteps(interval);
  const double h = interval / substeps;
  const DampedMassStep half(settings_.mass, settings_.damping, 0.5 * h);
  const DampedMassStep whole(settings_.mass, settings_.damping, h);
  const Vec3 rendered = toFree(force_W_);
  const auto hand = [this](double t, const PointState& motion) {
    return toFree(hand_->computeForce(t, toWorld(motion)));
  };

  for (int i = 0; i < substeps; ++i) {
    const double start = time_ + i * h;
    // Predict the middle. The velocity uses the hand's force at the start, so that a hand's damper
    // is second order. The position omits it, so that a spring is symplectic.
    const PointState middle = {
        half.advance(motion_, rendered).p_W,
        half.advance(motion_, rendered + hand(start, motion_)).v_W,
    };
    motion_ = whole.advance(motion_, rendered + hand(start + 0.5 * h, middle));
  }
}

}  // namespace tandem
