#pragma once

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Where a device's small workspace lies in the world.
struct WorkspaceSettings {
  Quat q_WD = Quat::Identity();  ///< turns the device's axes into the world's; unit
  Vec3 centre_D = Vec3::Zero();  ///< point of the device ... [m]
  Vec3 centre_W = Vec3::Zero();  ///< ... that is here in the world [m]
  double scale = 1.0;            ///< s: way in the world by way of the hand, > 0
  /// g: force on the hand by force in the world, > 0. 1: as many newtons as the world has, and the
  /// hand feels g s K of a spring K; 1 / s: the spring itself; s: no work is lost or won.
  double force_scale = 1.0;
};

/// Motions of a device D to the world W, forces back:
///
///   p_W = c_W + s R (p_D - c_D)      v_W = s R v_D      f_D = g R^T f_W
///
/// The hand's work is that of the world times g / s: f_D . v_D = g / s f_W . v_W. The factor is
/// constant and above zero, so what is passive in the world is passive at the hand, whatever s.
///
/// A value; pure and real-time safe but for its making.
class WorkspaceMap {
 public:
  /// Throws std::invalid_argument, naming the value, for settings out of range.
  explicit WorkspaceMap(const WorkspaceSettings& settings = {});

  [[nodiscard]] PointState toWorld(const PointState& hip_D) const noexcept;
  /// Force on the hand by the force in the world [N].
  [[nodiscard]] Vec3 toDevice(const Vec3& f_W) const noexcept;

  /// What the device can do, as seen from the world. The workspace is the half extents of the box
  /// along the world's axes that holds the turned one.
  [[nodiscard]] DeviceCapabilities toWorld(DeviceCapabilities capabilities) const;

  /// From now on `p_D` is at `p_W`; axes and scales stay.
  void place(const Vec3& p_D, const Vec3& p_W) noexcept;

  [[nodiscard]] const WorkspaceSettings& settings() const noexcept { return settings_; }

 private:
  WorkspaceSettings settings_;
  Eigen::Matrix3d r_WD_;
};

}  // namespace tandem
#pragma GCC visibility pop
