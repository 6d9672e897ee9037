#include "hid/rate_control.h"

#include <algorithm>
#include <cmath>

#include "guard/settings_check.h"

namespace tandem {
namespace {

RateControlSettings checked(RateControlSettings settings) {
  using falcon_detail::require;
  require(std::isfinite(settings.speed) && settings.speed > 0.0, "speed of the rate control",
          settings.speed, "finite and above 0 [m/s]");
  require(std::isfinite(settings.turn_speed) && settings.turn_speed >= 0.0,
          "turn_speed of the rate control", settings.turn_speed, "finite and at least 0 [rad/s]");
  require(settings.dead_zone >= 0.0 && settings.dead_zone < 1.0, "dead_zone of the rate control",
          settings.dead_zone, "at least 0 and below 1");
  require(std::isfinite(settings.smoothing) && settings.smoothing > 0.0,
          "smoothing of the rate control", settings.smoothing, "finite and above 0 [s]");
  require(settings.start_W.allFinite(), "start_W of the rate control", settings.start_W,
          "finite [m]");
  require(settings.workspace.allFinite() && (settings.workspace.array() > 0.0).all(),
          "workspace of the rate control", settings.workspace, "finite and above 0 [m]");
  const double norm = settings.q_WD.norm();
  require(std::abs(norm - 1.0) < 1e-3, "norm of q_WD of the rate control", norm, "1");
  settings.q_WD.normalize();
  return settings;
}

/// Scales the rest from the edge of the dead zone, so that there is no step.
double cutDeadZone(double part, double dead_zone) noexcept {
  const double beyond = std::min(std::abs(part), 1.0) - dead_zone;
  return beyond > 0.0 ? std::copysign(beyond / (1.0 - dead_zone), part) : 0.0;
}

}  // namespace

RateControl::RateControl(const RateControlSettings& settings) : settings_(checked(settings)) {
  point_.p_W = settings_.start_W;
}

void RateControl::setDisplacement(const Vec3& displacement_D, const Vec3& rotation_D) noexcept {
  const bool is_finite = displacement_D.allFinite() && rotation_D.allFinite();
  Vec3 parts = Vec3::Zero(), turns = Vec3::Zero();
  for (int i = 0; is_finite && i < 3; ++i) {
    parts[i] = cutDeadZone(displacement_D[i], settings_.dead_zone);
    turns[i] = cutDeadZone(rotation_D[i], settings_.dead_zone);
  }
  wanted_W_ = settings_.speed * (settings_.q_WD * parts);
  wanted_turn_W_ = settings_.turn_speed * (settings_.q_WD * turns);
}

void RateControl::stop() noexcept {
  wanted_W_.setZero();
  wanted_turn_W_.setZero();
  point_.v_W.setZero();
  wrist_.w_W.setZero();
}

void RateControl::advance(double interval) noexcept {
  if (!(interval > 0.0) || !std::isfinite(interval)) return;
  const double tau = settings_.smoothing;
  const double done = -std::expm1(-interval / tau);
  const Vec3 behind_W = wanted_W_ - point_.v_W;
  point_.p_W += interval * wanted_W_ - tau * done * behind_W;
  point_.v_W += done * behind_W;
  const Vec3 behind_turn_W = wanted_turn_W_ - wrist_.w_W;
  const Vec3 turn_W = interval * wanted_turn_W_ - tau * done * behind_turn_W;
  wrist_.w_W += done * behind_turn_W;
  if (const double angle = turn_W.norm(); angle > 0.0)
    wrist_.q_WH = (Quat(Eigen::AngleAxisd(angle, turn_W / angle)) * wrist_.q_WH).normalized();
  keepInBox();
}

void RateControl::putPoint(const Vec3& p_W) noexcept {
  if (!p_W.allFinite()) return;
  point_.p_W = p_W;
  keepInBox();
}

void RateControl::keepInBox() noexcept {
  const Vec3 low_W = settings_.start_W - settings_.workspace;
  const Vec3 high_W = settings_.start_W + settings_.workspace;
  for (int i = 0; i < 3; ++i) {
    if (point_.p_W[i] >= low_W[i] && point_.p_W[i] <= high_W[i]) continue;
    point_.p_W[i] = std::clamp(point_.p_W[i], low_W[i], high_W[i]);
    point_.v_W[i] = 0.0;
  }
}

}  // namespace tandem
