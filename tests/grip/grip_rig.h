#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tandem/coordination/simulated_link.h"
#include "tandem/falcon/haptic_device.h"
#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"

namespace tandem::test {

inline constexpr double kTick = 1e-3;          // [s]
inline constexpr double kHostStep = 1.0 / 60;  // [s]

/// A hand that moves as the test says, at full strength.
class ScriptedDevice final : public HapticDevice {
 public:
  using Path = std::function<Vec3(double t)>;

  explicit ScriptedDevice(Path path) : path_(std::move(path)) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    constexpr double kStep = 1e-6;
    const Vec3 v_W = (path_(now + kStep) - path_(now - kStep)) / (2.0 * kStep);
    return {{path_(now), v_W}, true};
  }
  void write(const Vec3& f_W) noexcept override { force_W = f_W; }
  [[nodiscard]] Vec3 at(double t) const { return path_(t); }

  Vec3 force_W = Vec3::Zero();

 private:
  Path path_;
  DeviceCapabilities limits_{"scripted"};
};

/// From 0 to 1 within `from` to `to` [s], without a jump of acceleration.
inline double glide(double t, double from, double to) {
  const double x = (t - from) / (to - from);
  if (x <= 0.0) return 0.0;
  if (x >= 1.0) return 1.0;
  return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
}

/// A host at 60 Hz with a user whose `Device` follows a path, at full strength.
template <typename Device>
struct HandHost {
  BulletRig rig;
  Device device;
  SiteSettings settings;
  std::optional<Site> site;
  double now = 0.0;

  HandHost(typename Device::Path path, const Vec3& gravity)
      : rig(gravity), device(std::move(path)) {
    settings.peers = 1;
    settings.passivity.enabled = false;
    settings.max_slew = std::numeric_limits<double>::infinity();
  }
  /// Steps the host; `look` sees each step.
  void run(
      double duration, const std::function<void()>& look = [] {}) {
    const double end = now + duration;
    while (now < end - 1e-9) {
      rig.step(kHostStep);
      now += kHostStep;
      look();
    }
  }
};

/// A floor at z = 0, one shared body on it and a hand.
struct GripHost : HandHost<ScriptedDevice> {
  btRigidBody* body = nullptr;

  explicit GripHost(ScriptedDevice::Path path) : HandHost(std::move(path), Vec3(0, 0, -9.81)) {
    rig.addBody(rig.makeShape<btBoxShape>(btVector3(5, 5, 1)), 0.0, Vec3(0, 0, -1));
  }
  /// The body lies on the floor, or has its centre at the height `z` [m].
  void start(double mass, const Vec3& half = Vec3::Constant(0.02), double z = 0.0) {
    const Vec3 p_W(0, 0, z > 0.0 ? z : half.z());
    body = &rig.addBody(rig.makeShape<btBoxShape>(toBullet(half)), mass, p_W);
    site.emplace(settings, rig.world, device);
    site->share(*body);
  }
  /// In Bullet, and in the island, which is at the end of its latest tick.
  [[nodiscard]] Vec3 at() const { return fromBullet(body->getWorldTransform().getOrigin()); }
  [[nodiscard]] Vec3 object() const { return site->object(0).p_W; }
  [[nodiscard]] Vec3 hand() const { return site->hip().p_W; }
};

/// The message with which `call` is refused; empty if it is not.
template <typename Call>
std::string reasonOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace tandem::test
