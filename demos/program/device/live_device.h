#pragma once

#include <memory>

#include "tandem/falcon/guarded_device.h"
#include "tandem/falcon/hid_switch.h"
#include "tandem/falcon/mapped_device.h"

#include "device/clutch.h"
#include "device/drivers.h"

namespace tandem::demos {

/// Where a device's middle and axes are in the world.
struct Placement {
  Quat q_WD = Quat::Identity();
  Vec3 centre_W = Vec3::Zero();
};

/// An opened device with all that stands between it and a site: map, guard, driver, clutch. It is
/// real, so whatever time a site tells, the monotonic clock counts here.
class LiveDevice final : public HapticDevice {
 public:
  /// Throws as MappedDevice, GuardedDevice and HidSwitch do.
  LiveDevice(DeviceSpec spec, Driver driver, const DeviceOptions& options,
             const Placement& placement);
  ~LiveDevice() override;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return mapped_->capabilities();
  }
  [[nodiscard]] DeviceSample read(double) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// How it does; for one thread.
  [[nodiscard]] DeviceReport report() { return driver_.report(); }

  /// From now on the world's point stands at `p_W`, with no force, until somebody writes, as a
  /// ticking site does; from there it goes on, wherever the hand is then. Not while a site ticks.
  void holdUntilTicked(const Vec3& p_W) noexcept;

  /// Hand's way from the middle of its workspace, as of the last read [m].
  [[nodiscard]] double distanceFromMiddle() const noexcept;

  /// Whether the clutch is in, as of the last read.
  [[nodiscard]] bool isEngaged() const noexcept { return mapped_->isEngaged(); }
  [[nodiscard]] const DeviceSpec& spec() const noexcept { return spec_; }
  [[nodiscard]] const WorkspaceMap& map() const noexcept { return mapped_->map(); }
  [[nodiscard]] const GuardStatus& guard() const noexcept { return guarded_->status(); }
  /// Null unless it is emulated.
  [[nodiscard]] EmulatedUser* emulated() noexcept { return driver_.emulated.get(); }

 private:
  [[nodiscard]] bool isClutchPressed() const noexcept;

  DeviceSpec spec_;
  Driver driver_;  ///< its device is in mapped_, which therefore goes first
  std::unique_ptr<HidSwitch> pedal_;
  std::uint8_t clutch_button_ = 0;
  GuardedDevice* guarded_ = nullptr;
  std::unique_ptr<MappedDevice> mapped_;
  Placement placement_;
  bool is_held_ = false;  ///< until it is ticked
  Vec3 p_W_ = Vec3::Zero();
};

}  // namespace tandem::demos
