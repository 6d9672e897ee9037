#include <algorithm>
#include <stdexcept>
#include <string>

#include "tandem/falcon/simulated_device.h"

#include "c/device.h"
#include "c/values.h"

namespace tandem::c_door {
namespace {

/// Time for which a hand continues after its last move [s].
constexpr double kGoesOn = 0.05;

[[nodiscard]] DeviceCapabilities readLimits(const char* name, const TandemDeviceLimits& limits) {
  if (!(limits.max_force >= 0.0))
    refuseValue("max_force", limits.max_force, "0 or more [N]; INFINITY: any");
  if (!(limits.max_slew > 0.0))
    refuseValue("max_slew", limits.max_slew, "above 0 [N/s]; INFINITY: any");
  DeviceCapabilities capabilities;
  capabilities.name = name;
  capabilities.max_force = limits.max_force;
  capabilities.max_slew = limits.max_slew;
  return capabilities;
}

/// A device made of the caller's functions; those of a wrist may be missing.
class CalledDevice final : public HapticDevice {
 public:
  CalledDevice(const TandemDeviceFunctions& functions, const TandemWristFunctions& wrist,
               const DeviceCapabilities& limits)
      : functions_(functions), wrist_(wrist), limits_(limits) {
    if (wrist.write) limits_.max_torque = wrist.max_torque;
  }

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    DeviceSample sample;
    Triple p{}, v{};
    sample.valid = functions_.read(functions_.user, now, p.data(), v.data()) != 0;
    sample.hip = {{p[0], p[1], p[2]}, {v[0], v[1], v[2]}};
    std::array<double, 4> q{};
    Triple w{};
    if (wrist_.read && wrist_.read(functions_.user, now, q.data(), w.data()) != 0)
      sample.wrist = WristState{Quat(q[3], q[0], q[1], q[2]), {w[0], w[1], w[2]}};
    return sample;
  }
  void write(const Vec3& f_W) noexcept override {
    const Triple f{f_W.x(), f_W.y(), f_W.z()};
    functions_.write(functions_.user, f.data());
  }
  void writeTorque(const Vec3& t_W) noexcept override {
    const Triple t{t_W.x(), t_W.y(), t_W.z()};
    if (wrist_.write) wrist_.write(functions_.user, t.data());
  }

 private:
  TandemDeviceFunctions functions_;
  TandemWristFunctions wrist_;
  DeviceCapabilities limits_;
};

[[nodiscard]] Triple toTriple(const Vec3& v) noexcept { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] Vec3 toVec3(const Triple& values) noexcept {
  return {values[0], values[1], values[2]};
}

template <typename Kind>
[[nodiscard]] Kind& checkKind(Kind* kind, const char* function, const char* maker) {
  if (!kind)
    throw std::invalid_argument(std::string(function) + " is for devices of " + maker +
                                "; make one of that kind");
  return *kind;
}

[[nodiscard]] TandemDevice* makeCalled(const TandemDeviceFunctions& functions,
                                       const TandemWristFunctions& wrist,
                                       const TandemDeviceLimits& limits) {
  if (!functions.read) refuseNull("functions.read");
  if (!functions.write) refuseNull("functions.write");
  return Shells<TandemDevice>::all().wrap(std::make_unique<Device>(
      std::make_unique<CalledDevice>(functions, wrist, readLimits("called", limits))));
}

}  // namespace

MovedDevice::MovedDevice(const Vec3& start_W, const DeviceCapabilities& limits)
    : limits_(limits), telling_{toTriple(start_W), {}, {}, {}, false}, told_(telling_) {}

void MovedDevice::move(const Vec3& p_W, const Vec3& v_W) noexcept {
  telling_.p_W = toTriple(p_W);
  telling_.v_W = toTriple(v_W);
  told_.write(telling_);
}

void MovedDevice::turn(const Quat& q_WH, const Vec3& w_W) noexcept {
  telling_.q_WH = {q_WH.x(), q_WH.y(), q_WH.z(), q_WH.w()};
  telling_.w_W = toTriple(w_W);
  telling_.has_wrist = true;
  told_.write(telling_);
}

DeviceSample MovedDevice::read(double now) noexcept {
  if (told_.isNew()) since_ = now;
  const Motion& motion = told_.read();
  const double age = std::clamp(now - since_, 0.0, kGoesOn);
  const bool goes_on = age < kGoesOn;
  const Vec3 v_W = toVec3(motion.v_W), w_W = toVec3(motion.w_W), still = Vec3::Zero();
  DeviceSample sample{{toVec3(motion.p_W) + age * v_W, goes_on ? v_W : still}, true};
  if (!motion.has_wrist) return sample;
  const Quat q_WH(motion.q_WH[3], motion.q_WH[0], motion.q_WH[1], motion.q_WH[2]);
  const double rate = w_W.norm();
  sample.wrist = WristState{q_WH, goes_on ? w_W : still};
  if (rate > 0.0) sample.wrist->q_WH = Quat(Eigen::AngleAxisd(age * rate, w_W / rate)) * q_WH;
  return sample;
}

Vec3 SteeredHand::computeForce(double, const PointState&) const noexcept {
  return toVec3(force_W_.read());
}

}  // namespace tandem::c_door

using namespace tandem;          // NOLINT: the functions of the header are in no namespace
using namespace tandem::c_door;  // NOLINT

extern "C" {

TandemResult tandem_device_create_moved(const double start[3], TandemDeviceLimits limits,
                                        TandemDevice** device) {
  return guarded([&] {
    auto& out = checkPointer(device, "device");
    auto moved =
        std::make_unique<MovedDevice>(readVec3("start", start), readLimits("moved", limits));
    MovedDevice& kept = *moved;
    auto made = std::make_unique<Device>(std::move(moved));
    made->moved = &kept;
    out = Shells<TandemDevice>::all().wrap(std::move(made));
  });
}

TandemResult tandem_device_move(TandemDevice* device, const double position[3],
                                const double velocity[3]) {
  return guarded([&] {
    MovedDevice& moved =
        checkKind(open(device).moved, "tandem_device_move()", "tandem_device_create_moved()");
    const Vec3 p_W = readVec3("position", position), v_W = readVec3("velocity", velocity);
    moved.move(p_W, v_W);
  });
}

TandemResult tandem_device_turn(TandemDevice* device, const double orientation[4],
                                const double angular_velocity[3]) {
  return guarded([&] {
    MovedDevice& moved =
        checkKind(open(device).moved, "tandem_device_turn()", "tandem_device_create_moved()");
    const Quat q_WH = readOrientation("orientation", orientation);
    moved.turn(q_WH, readVec3("angular_velocity", angular_velocity));
  });
}

TandemResult tandem_device_create_simulated(double mass, double damping, const double start[3],
                                            const double* guide, TandemDevice** device) {
  return guarded([&] {
    auto& out = checkPointer(device, "device");
    SimulatedDeviceSettings settings;
    settings.mass = mass;
    settings.damping = damping;
    settings.start_W = readVec3("start", start);
    if (guide) settings.guide = readUnitVec3("guide", guide);
    auto hand = std::make_unique<SteeredHand>();
    SteeredHand& kept = *hand;
    auto made =
        std::make_unique<Device>(std::make_unique<SimulatedDevice>(settings, std::move(hand)));
    made->hand = &kept;
    out = Shells<TandemDevice>::all().wrap(std::move(made));
  });
}

TandemResult tandem_device_set_hand(TandemDevice* device, const double force[3]) {
  return guarded([&] {
    SteeredHand& hand = checkKind(open(device).hand, "tandem_device_set_hand()",
                                  "tandem_device_create_simulated()");
    hand.setForce(readVec3("force", force));
  });
}

TandemResult tandem_device_create(TandemDeviceFunctions functions, TandemDeviceLimits limits,
                                  TandemDevice** device) {
  return guarded([&] {
    auto& out = checkPointer(device, "device");
    out = makeCalled(functions, {}, limits);
  });
}

TandemResult tandem_device_create_turning(TandemDeviceFunctions functions,
                                          TandemWristFunctions wrist, TandemDeviceLimits limits,
                                          TandemDevice** device) {
  return guarded([&] {
    auto& out = checkPointer(device, "device");
    if (!wrist.read) refuseNull("wrist.read");
    requireNotNegative("wrist.max_torque", wrist.max_torque);
    out = makeCalled(functions, wrist, limits);
  });
}

TandemResult tandem_device_get_force(const TandemDevice* device, double force[3]) {
  return guarded([&] {
    Device& of = open(device);
    checkPointer(force, "force");
    writeVec3(toVec3(of.haptic.force()), force);
  });
}

TandemResult tandem_device_destroy(TandemDevice* device) {
  return guarded([&] { Shells<TandemDevice>::all().destroy(device); });
}

}  // extern "C"
