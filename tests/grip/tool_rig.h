#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "grip/grip_rig.h"

namespace tandem::test {

/// A hand of six degrees of freedom that moves and turns as the test says, at full strength.
class WristDevice final : public HapticDevice {
 public:
  struct Pose {
    Vec3 p_W = Vec3::Zero();
    Quat q_WH = Quat::Identity();
  };
  using Path = std::function<Pose(double t)>;

  explicit WristDevice(Path path, double max_torque = 1.0) : path_(std::move(path)) {
    limits_.name = "scripted wrist";
    limits_.max_torque = max_torque;
  }
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    constexpr double kStep = 1e-6;
    const Pose before = path_(now - kStep), after = path_(now + kStep), at = path_(now);
    const Eigen::AngleAxisd turned(after.q_WH * before.q_WH.conjugate());
    DeviceSample sample;
    sample.hip = {at.p_W, (after.p_W - before.p_W) / (2.0 * kStep)};
    sample.wrist = WristState{at.q_WH, turned.angle() / (2.0 * kStep) * turned.axis()};
    sample.valid = true;
    return sample;
  }
  void write(const Vec3& f_W) noexcept override { force_W = f_W; }
  void writeTorque(const Vec3& t_W) noexcept override { torque_W = t_W; }
  [[nodiscard]] Pose at(double t) const { return path_(t); }

  Vec3 force_W = Vec3::Zero(), torque_W = Vec3::Zero();

 private:
  Path path_;
  DeviceCapabilities limits_;
};

/// A host at 60 Hz with a hand that has a wrist.
struct ToolHost : HandHost<WristDevice> {
  explicit ToolHost(WristDevice::Path path, const Vec3& gravity = Vec3::Zero())
      : HandHost(std::move(path), gravity) {}
  void attach() { site.emplace(settings, rig.world, device); }
};

}  // namespace tandem::test
