#pragma once

#include <atomic>
#include <memory>

#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Placement of a device's small workspace in the world.
struct WorkspaceSettings {
  Quat q_WD = Quat::Identity();  ///< rotation from the device's frame to the world's; unit
  Vec3 centre_D = Vec3::Zero();  ///< point of the device [m] that maps to centre_W
  Vec3 centre_W = Vec3::Zero();  ///< image of centre_D in the world [m]
  double scale = 1.0;            ///< s: world displacement per hand displacement, > 0
  /// g: force on the hand per force in the world, > 0. A world spring K feels like g s K. With g =
  /// 1 the hand feels the world's newtons, with 1 / s its stiffness, with s equal work.
  double force_scale = 1.0;
};

/// Maps motions of a device D to the world W, and forces back:
///
///   p_W = c_W + s R (p_D - c_D)      v_W = s R v_D      f_D = g R^T f_W
///   q_WH = R q_DH                    w_W = R w_D        t_D = g / s R^T t_W
///
/// The hand's work is the world's times g / s: f_D . v_D = g / s f_W . v_W, and the same for
/// torques. The factor is constant and positive, so a passive world stays passive at the hand for
/// any s.
///
/// A value. Pure and real-time safe except for construction.
class WorkspaceMap {
 public:
  /// Throws std::invalid_argument with the value's name for settings out of range.
  explicit WorkspaceMap(const WorkspaceSettings& settings = {});

  [[nodiscard]] PointState toWorld(const PointState& hip_D) const noexcept;
  /// Force on the hand for a force in the world [N].
  [[nodiscard]] Vec3 toDevice(const Vec3& f_W) const noexcept;

  [[nodiscard]] WristState toWorld(const WristState& wrist_D) const noexcept;
  /// Torque on the hand for a torque in the world [N m].
  [[nodiscard]] Vec3 torqueToDevice(const Vec3& t_W) const noexcept;

  /// Capabilities of the device seen from the world. The workspace becomes the half extents of the
  /// world-aligned box around the rotated one.
  [[nodiscard]] DeviceCapabilities toWorld(DeviceCapabilities capabilities) const;

  /// Makes `p_D` map to `p_W` from now on. Axes and scales stay.
  void place(const Vec3& p_D, const Vec3& p_W) noexcept;

  [[nodiscard]] const WorkspaceSettings& settings() const noexcept { return settings_; }

 private:
  WorkspaceSettings settings_;
  Eigen::Matrix3d r_WD_;
};

/// A device seen through a WorkspaceMap, with a clutch. The inner device's W is its own frame D.
///
/// While the clutch is out the world point stands still and the hand feels no force. A wrist still
/// turns. The hand can then return to the middle of its workspace. When the clutch engages, the map
/// is placed anew and the point continues from where it stands. An invalid reading neither moves
/// the point nor places the map.
///
/// A device that returns with other positions (homed again) keeps its old map, so the point jumps
/// to the hand. Open and close the clutch to place it anew.
class MappedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument if there is no device or a setting is out of range.
  MappedDevice(std::unique_ptr<HapticDevice> device, const WorkspaceSettings& settings);

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;
  void writeTorque(const Vec3& t_W) noexcept override;

  /// Engages the clutch (true, the initial state) or opens it, from the next read on. For any
  /// thread.
  void setEngaged(bool is_engaged) noexcept {
    is_wanted_.store(is_engaged, std::memory_order_relaxed);
  }
  /// State of the clutch at the last read. For the thread that reads.
  [[nodiscard]] bool isEngaged() const noexcept { return is_engaged_; }

  /// Puts the world point at `p_W`; it moves on from there when the clutch engages. A scene uses it
  /// to choose the start, wherever the hand is. Returns false and does nothing unless the clutch
  /// was out at the last read. For the thread that reads.
  bool putPoint(const Vec3& p_W) noexcept;

  /// The current map; the clutch moves its centres. For the thread that reads.
  [[nodiscard]] const WorkspaceMap& map() const noexcept { return map_; }

 private:
  std::unique_ptr<HapticDevice> device_;
  WorkspaceMap map_;
  DeviceCapabilities capabilities_;
  std::atomic<bool> is_wanted_{true};
  bool is_engaged_ = true, was_read_ = false;
  Vec3 p_W_;  ///< world point of the last valid reading
};

}  // namespace tandem
#pragma GCC visibility pop
