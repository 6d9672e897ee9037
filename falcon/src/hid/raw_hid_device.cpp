#include "tandem/falcon/raw_hid_device.h"

#include <cmath>
#include <utility>

#include "guard/settings_check.h"
#include "guard/velocity_estimator.h"
#include "hid/hid_stream.h"
#include "hid/raw_hid_client.h"
#include "novint/arm_range.h"
#include "novint/falcon_kinematics.h"

namespace tandem {

using falcon_detail::RawHidClient;

namespace {

constexpr double kMostForce = 8.0;       // [N]
constexpr double kMostSlew = 2000.0;     // [N/s]
constexpr double kHalfWorkspace = 0.05;  // [m]
constexpr double kLongestStep = 0.1;     // longest step between two positions for a velocity [s]

RawHidSettings checked(RawHidSettings settings) {
  using falcon_detail::require;
  require(settings.max_force > 0.0 && settings.max_force <= kMostForce,
          "max_force of the raw HID device", settings.max_force, "above 0, at most 8 [N]");
  require(std::isfinite(settings.ramp_in) && settings.ramp_in >= 0.0,
          "ramp_in of the raw HID device", settings.ramp_in, "finite and at least 0 [s]");
  require(settings.origin_D.allFinite(), "origin_D of the raw HID device", settings.origin_D,
          "finite [m]");
  const double norm = settings.q_WD.norm();
  require(std::abs(norm - 1.0) < 1e-3, "norm of q_WD of the raw HID device", norm, "1");
  settings.q_WD.normalize();
  const double period = settings.stream.write_period;
  require(period > 0.0 && period <= 0.01, "write_period of the raw HID device", period,
          "above 0, at most 0.01 [s]");
  return settings;
}

FalconForceLimits makeLimits(const RawHidSettings& settings) noexcept {
  FalconForceLimits limits;
  limits.max_force = settings.max_force;
  limits.max_slew = kMostSlew;
  limits.ramp_in = settings.ramp_in;
  limits.hold = RawHidDevice::kCommand;
  limits.fade = 0.0;  // no fade: the gate closes and the slew limits the force
  return limits;
}

/// Torques per force of 1 N along each axis. Not finite where the legs are stretched.
Eigen::Matrix3d computeTorquesByForce(const FalconPose& pose) noexcept {
  return pose.dangles_dp.transpose().inverse();
}

}  // namespace

/// State of the grip from the newest report.
struct RawHidDevice::Grip {
  FalconKinematics kinematics;
  std::optional<FalconPose> pose;  ///< empty: unusable
  AdaptiveWindow count_rates = makeUsualVelocityEstimator();
};

RawHidDevice::RawHidDevice(HidOpener open, const RawHidSettings& settings)
    : settings_(checked(settings)),
      grip_(std::make_unique<Grip>(Grip{FalconKinematics(settings.geometry), {}})),
      client_(std::make_unique<RawHidClient>(makeLimits(settings_))),
      stream_(std::make_unique<HidStream>(std::move(open), *client_, settings_.stream)) {
  capabilities_.name = "raw HID";
  capabilities_.max_force = settings_.max_force;
  capabilities_.max_slew = kMostSlew;
  capabilities_.workspace = Vec3::Constant(kHalfWorkspace);
}

RawHidDevice::~RawHidDevice() = default;

const DeviceCapabilities& RawHidDevice::capabilities() const noexcept { return capabilities_; }

DeviceSample RawHidDevice::read(double now) noexcept {
  std::optional<FalconPose>& pose = grip_->pose;
  const RawHidClient::Heard& heard = client_->newest();
  const std::uint64_t closures = client_->closures();
  const bool was_closed = closures != closures_;
  closures_ = closures;
  if (was_closed) pose.reset();  // a jump after the fault is no motion of the grip
  if (heard.count != heard_) {
    heard_ = heard.count;
    heard_at_ = now;
    takeState(heard.state);
  }
  if (!heard.is_connected || !(now - heard_at_ <= kFresh)) pose.reset();
  const bool was_usable = is_usable_;
  is_usable_ = pose && !was_closed;
  if (was_usable && !is_usable_ && !was_closed) client_->close();
  if (!is_usable_) return {};
  const Quat& q_WD = settings_.q_WD;
  return {{q_WD * (pose->p_D - settings_.origin_D), q_WD * v_D_}, true, {}, heard.state.buttons};
}

void RawHidDevice::takeState(const RawHidState& state) noexcept {
  std::optional<FalconPose>& pose = grip_->pose;
  const std::optional<FalconPose> last = pose;
  const double step = 1e-6 * static_cast<std::uint32_t>(state.time_us - time_us_);
  time_us_ = state.time_us;
  const FalconAngles angles(angleOfCounts(state.counts[0]), angleOfCounts(state.counts[1]),
                            angleOfCounts(state.counts[2]));
  pose = state.isHomed() && falcon_detail::areInRange(angles)
             ? grip_->kinematics.computePoseOfAngles(angles)
             : std::nullopt;
  if (pose && !computeTorquesByForce(*pose).allFinite()) pose.reset();
  device_time_ += step;
  if (!last || step <= 0.0 || step > kLongestStep) grip_->count_rates.clear();
  const Vec3 counts(state.counts[0], state.counts[1], state.counts[2]);
  const Vec3 angle_rates = angleRatesOfCounts(grip_->count_rates.add(device_time_, counts));
  const auto v_D = pose ? computeVelocity(*pose, angle_rates) : std::nullopt;
  v_D_ = v_D.value_or(Vec3(Vec3::Zero()));
}

void RawHidDevice::write(const Vec3& f_W) noexcept {
  falcon_detail::RawHidWish& wish = client_->nextWish();
  wish.is_usable = is_usable_ && f_W.allFinite();
  wish.closures = closures_;
  if (wish.is_usable) {  // otherwise the force fades at the grip's last pose
    Eigen::Map<Vec3>(wish.f_D.data()) = settings_.q_WD.conjugate() * f_W;
    Eigen::Map<Eigen::Matrix3d>(wish.torques_by_force.data()) = computeTorquesByForce(*grip_->pose);
  }
  client_->passWishOn();
}

RawHidStatus RawHidDevice::status() {
  const RawHidClient::Heard& heard = client_->newest();
  return {heard.state,     heard.is_connected, client_->lost(),
          stream_->name(), stream_->trouble(), stream_->counters()};
}

}  // namespace tandem
