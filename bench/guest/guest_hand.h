#pragma once

#include "tandem/falcon/haptic_device.h"

#include "bench/guest/guest_case.h"
#include "bench/program/draw.h"

namespace tandem::demos::bench {

/// A device whose hand follows, presses, leaps or goes away, whatever the force.
class GuestDevice final : public HapticDevice {
 public:
  GuestDevice(GuestHand hand, std::uint64_t seed);

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return capabilities_;
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  void setHand(GuestHand hand) { hand_ = hand; }
  /// Place of the body that the hand is busy with.
  void setTarget(const Vec3& p_W) { target_W_ = p_W; }

  /// False if the site ever wrote a force that is not finite or too large.
  [[nodiscard]] bool isForceSane() const { return is_force_sane_; }
  [[nodiscard]] const Vec3& force() const { return f_W_; }
  [[nodiscard]] const Vec3& position() const { return hip_.p_W; }
  /// Upper bound of the energy that the hand has put in [J].
  [[nodiscard]] double work() const { return work_; }

 private:
  [[nodiscard]] Vec3 findGoal(double now);

  DeviceCapabilities capabilities_;
  GuestHand hand_;
  Draw draw_;
  PointState hip_;
  Vec3 target_W_ = Vec3::Zero(), f_W_ = Vec3::Zero();
  double last_ = 0.0, next_leap_ = 0.0;  // [s]
  double work_ = 0.0;
  bool is_force_sane_ = true;
};

}  // namespace tandem::demos::bench
