#pragma once

#include <memory>

#include "tandem/falcon/guarded_device.h"
#include "tandem/falcon/mapped_device.h"

#include "device/device_switch.h"
#include "device/drivers.h"

namespace tandem::demos {

/// Place of a device's middle and direction of its axes in the world.
struct Placement {
  Quat q_WD = Quat::Identity();
  Vec3 centre_W = Vec3::Zero();
};

/// An opened device with all layers between it and a site: map, guard, driver, clutch. It also has
/// the switch by which the user holds things. It is real, so it uses the monotonic clock, not the
/// site's time.
class LiveDevice final : public HapticDevice {
 public:
  /// Throws like MappedDevice, GuardedDevice and HidSwitch.
  LiveDevice(DeviceSpec spec, Driver driver, const DeviceOptions& options,
             const Placement& placement);
  ~LiveDevice() override;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return mapped_->capabilities();
  }
  [[nodiscard]] DeviceSample read(double) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// State of the device; for one thread.
  [[nodiscard]] DeviceReport report() { return driver_.report(); }

  /// Holds the world's point at `p_W` without force until the first write, as by a ticking site.
  /// The point then continues from there, at any place of the hand. Do not call it while a site
  /// ticks.
  void holdUntilTicked(const Vec3& p_W) noexcept;

  /// Distance of the hand from the middle of its workspace at the last read [m].
  [[nodiscard]] double distanceFromMiddle() const noexcept;

  /// True if the clutch was in at the last read.
  [[nodiscard]] bool isEngaged() const noexcept { return mapped_->isEngaged(); }
  /// True if the user has something to grip with: --grip, or what a driver's devices usually have.
  [[nodiscard]] bool hasGrip() const noexcept { return grip_.isThere(); }
  /// True while the user wants to hold something. For any thread.
  [[nodiscard]] bool isGripPressed() const noexcept { return grip_.isPressed(driver_); }
  [[nodiscard]] const DeviceSpec& spec() const noexcept { return spec_; }
  [[nodiscard]] const WorkspaceMap& map() const noexcept { return mapped_->map(); }
  [[nodiscard]] const GuardStatus& guard() const noexcept { return guarded_->status(); }
  /// Null unless the device is emulated.
  [[nodiscard]] EmulatedUser* emulated() noexcept { return driver_.emulated.get(); }

 private:
  DeviceSpec spec_;
  Driver driver_;  ///< its device is in mapped_, which is destroyed first
  DeviceSwitch clutch_, grip_;
  GuardedDevice* guarded_ = nullptr;
  std::unique_ptr<MappedDevice> mapped_;
  Placement placement_;
  bool is_held_ = false;  ///< true until a site ticks it
  Vec3 p_W_ = Vec3::Zero();
};

}  // namespace tandem::demos
