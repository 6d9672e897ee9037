#pragma once

#include <memory>
#include <utility>

#include "tandem/falcon/haptic_device.h"

namespace tandem::test {

/// Samples that a ToldDevice returns, and the force and torque it received. Must outlive the
/// device.
struct DeviceScript {
  DeviceCapabilities capabilities;
  DeviceSample sample{{}, true};  ///< returned by the next reads
  Vec3 force = Vec3::Constant(99.0), torque = Vec3::Constant(99.0);
  int writes = 0;
};

/// A device that reads from its script, and stores the last force there.
class ToldDevice final : public HapticDevice {
 public:
  explicit ToldDevice(DeviceScript& script) : script_(script) {}

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return script_.capabilities;
  }
  [[nodiscard]] DeviceSample read(double) noexcept override { return script_.sample; }
  void write(const Vec3& f_W) noexcept override {
    script_.force = f_W;
    ++script_.writes;
  }
  void writeTorque(const Vec3& t_W) noexcept override { script_.torque = t_W; }

 private:
  DeviceScript& script_;
};

}  // namespace tandem::test
