#pragma once

#include <optional>

#include "tandem/falcon/haptic_device.h"

namespace tandem::test {

/// Measures the energy that a device's hand puts in: the work against the force as it was held,
/// between any two reads.
class MeteredDevice final : public HapticDevice {
 public:
  explicit MeteredDevice(HapticDevice& device) : device_(device) {}

  const DeviceCapabilities& capabilities() const noexcept override {
    return device_.capabilities();
  }
  DeviceSample read(double now) noexcept override {
    const DeviceSample sample = device_.read(now);
    if (sample.valid) {
      if (p_W_) put_in_ -= force_W_.dot(sample.hip.p_W - *p_W_);
      p_W_ = sample.hip.p_W;
    }
    return sample;
  }
  void write(const Vec3& f_W) noexcept override {
    force_W_ = f_W;
    device_.write(f_W);
  }

  /// Energy put in so far [J]; negative: the hand got some.
  [[nodiscard]] double putIn() const noexcept { return put_in_; }

 private:
  HapticDevice& device_;
  Vec3 force_W_ = Vec3::Zero();
  std::optional<Vec3> p_W_;
  double put_in_ = 0.0;
};

}  // namespace tandem::test
