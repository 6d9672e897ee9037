#pragma once

#include <atomic>
#include <memory>

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

/// A device seen through a WorkspaceMap, with a clutch. Of the device beneath, what is called W in
/// the interface is its own frame D.
///
/// While the clutch is out the world's point stands still and the hand feels nothing, so that it
/// can go back to the middle of its workspace; when it takes again the map is placed anew, so that
/// the point goes on from where it stands. A reading that is not valid moves nothing and places
/// nothing. A device that comes back with other positions (homed again) is mapped as before: the
/// point is then where the hand is; let the clutch out and in to place it anew.
class MappedDevice final : public HapticDevice {
 public:
  /// Throws std::invalid_argument for no device or settings out of range.
  MappedDevice(std::unique_ptr<HapticDevice> device, const WorkspaceSettings& settings);

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// Lets the clutch in (true, as at first) or out; from the next read on. From any thread.
  void setEngaged(bool is_engaged) noexcept {
    is_wanted_.store(is_engaged, std::memory_order_relaxed);
  }
  /// As of the last read. For the thread that reads.
  [[nodiscard]] bool isEngaged() const noexcept { return is_engaged_; }

  /// Puts the world's point at `p_W`, from where it goes on when the clutch takes: a scene can say
  /// where it starts, wherever the hand is. False, and nothing, unless the clutch is out as of the
  /// last read. For the thread that reads.
  bool putPoint(const Vec3& p_W) noexcept;

  /// As it is now: the clutch has moved its centres. For the thread that reads.
  [[nodiscard]] const WorkspaceMap& map() const noexcept { return map_; }

 private:
  std::unique_ptr<HapticDevice> device_;
  WorkspaceMap map_;
  DeviceCapabilities capabilities_;
  std::atomic<bool> is_wanted_{true};
  bool is_engaged_ = true, was_read_ = false;
  Vec3 p_W_;  ///< of the last valid reading; where the point stands
};

}  // namespace tandem
#pragma GCC visibility pop
