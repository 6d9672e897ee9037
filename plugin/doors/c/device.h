#pragma once

#include <array>
#include <memory>

#include "tandem/falcon/haptic_device.h"
#include "tandem/falcon/simulated_device.h"

#include "c/handle.h"
#include "falcon/src/guard/latest_value.h"

namespace tandem::c_door {

/// Plain numbers that threads can exchange.
using Triple = std::array<double, 3>;

/// A device that the caller moves and turns, in one thread. Another may read it.
class MovedDevice final : public HapticDevice {
 public:
  MovedDevice(const Vec3& start_W, const DeviceCapabilities& limits);

  void move(const Vec3& p_W, const Vec3& v_W) noexcept;
  void turn(const Quat& q_WH, const Vec3& w_W) noexcept;

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3&) noexcept override {}

 private:
  struct Motion {
    Triple p_W{}, v_W{}, w_W{};
    std::array<double, 4> q_WH{};
    bool has_wrist = false;
  };
  DeviceCapabilities limits_;
  Motion telling_;  ///< for the thread that moves
  LatestValue<Motion> told_;
  double since_ = 0.0;  ///< time at which the motion was first read [s]
};

/// Hand of a simulated device: a force that another thread may change.
class SteeredHand final : public Hand {
 public:
  void setForce(const Vec3& f_W) noexcept { force_W_.write({f_W.x(), f_W.y(), f_W.z()}); }
  [[nodiscard]] Vec3 computeForce(double, const PointState&) const noexcept override;

 private:
  mutable LatestValue<Triple> force_W_;
};

/// Shows the last written force to another thread.
class ShownForce final : public HapticDevice {
 public:
  explicit ShownForce(std::unique_ptr<HapticDevice> device) : device_(std::move(device)) {}

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return device_->capabilities();
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override { return device_->read(now); }
  void write(const Vec3& f_W) noexcept override {
    device_->write(f_W);
    force_W_.write({f_W.x(), f_W.y(), f_W.z()});
  }
  void writeTorque(const Vec3& t_W) noexcept override { device_->writeTorque(t_W); }
  [[nodiscard]] const Triple& force() noexcept { return force_W_.read(); }

 private:
  std::unique_ptr<HapticDevice> device_;
  LatestValue<Triple> force_W_;
};

struct Device {
  static constexpr std::uint32_t kKind = 0x54644556;
  static constexpr const char* kName = "device";
  static constexpr const char* kUser = "a site";

  explicit Device(std::unique_ptr<HapticDevice> device) : haptic(std::move(device)) {}

  ShownForce haptic;
  MovedDevice* moved = nullptr;  ///< null: a device of another kind
  SteeredHand* hand = nullptr;   ///< null: a device of another kind
};

}  // namespace tandem::c_door

struct TandemDevice : tandem::c_door::Handle<tandem::c_door::Device> {};
