#include <cmath>
#include <limits>

#include "tandem/falcon/mapped_device.h"

#include "guard/settings_check.h"

namespace tandem {
namespace {

using falcon_detail::require;

constexpr double kUnitTolerance = 1e-6;  // accepts a unit quaternion written with seven digits

WorkspaceSettings checked(WorkspaceSettings settings) {
  const double norm = settings.q_WD.norm();
  require(std::abs(norm - 1.0) <= kUnitTolerance, "norm of q_WD of the workspace", norm,
          "1: divide the quaternion by it");
  settings.q_WD.normalize();
  require(settings.centre_D.allFinite(), "centre_D of the workspace", settings.centre_D,
          "finite [m]");
  require(settings.centre_W.allFinite(), "centre_W of the workspace", settings.centre_W,
          "finite [m]");
  require(std::isfinite(settings.scale) && settings.scale > 0.0, "scale of the workspace",
          settings.scale, "finite and above 0; 1 moves the world's point as the hand moves");
  require(std::isfinite(settings.force_scale) && settings.force_scale > 0.0,
          "force_scale of the workspace", settings.force_scale,
          "finite and above 0; 1 gives the hand the world's newtons");
  return settings;
}

}  // namespace

WorkspaceMap::WorkspaceMap(const WorkspaceSettings& settings)
    : settings_(checked(settings)), r_WD_(settings_.q_WD.toRotationMatrix()) {}

PointState WorkspaceMap::toWorld(const PointState& hip_D) const noexcept {
  const Vec3 way_D = hip_D.p_W - settings_.centre_D;
  return {settings_.centre_W + settings_.scale * (r_WD_ * way_D),
          settings_.scale * (r_WD_ * hip_D.v_W)};
}

Vec3 WorkspaceMap::toDevice(const Vec3& f_W) const noexcept {
  return settings_.force_scale * (r_WD_.transpose() * f_W);
}

WristState WorkspaceMap::toWorld(const WristState& wrist_D) const noexcept {
  return {(settings_.q_WD * wrist_D.q_WH).normalized(), r_WD_ * wrist_D.w_W};
}

Vec3 WorkspaceMap::torqueToDevice(const Vec3& t_W) const noexcept {
  return settings_.force_scale / settings_.scale * (r_WD_.transpose() * t_W);
}

DeviceCapabilities WorkspaceMap::toWorld(DeviceCapabilities capabilities) const {
  capabilities.max_force /= settings_.force_scale;
  capabilities.max_torque *= settings_.scale / settings_.force_scale;
  capabilities.max_slew /= settings_.force_scale;
  capabilities.max_stiffness /= settings_.scale * settings_.force_scale;
  // Infinity times a zero of the rotation is NaN, so one infinite extent makes all infinite.
  if (capabilities.workspace.allFinite())
    capabilities.workspace = settings_.scale * (r_WD_.cwiseAbs() * capabilities.workspace);
  else
    capabilities.workspace.setConstant(std::numeric_limits<double>::infinity());
  return capabilities;
}

void WorkspaceMap::place(const Vec3& p_D, const Vec3& p_W) noexcept {
  settings_.centre_D = p_D;
  settings_.centre_W = p_W;
}

}  // namespace tandem
