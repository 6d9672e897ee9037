#pragma once

#include <memory>
#include <utility>

#include "tandem/falcon/haptic_device.h"

namespace tandem::test {

/// What a ToldDevice is told, and what it was given; outlives it.
struct DeviceScript {
  DeviceCapabilities capabilities;
  DeviceSample sample{{}, true};  ///< of the next reads
  Vec3 force = Vec3::Constant(99.0);
  int writes = 0;
};

/// A device that reads as its script says, and keeps the last force there.
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

 private:
  DeviceScript& script_;
};

}  // namespace tandem::test
