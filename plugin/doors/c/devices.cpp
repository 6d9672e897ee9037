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

/// A device made of the caller's functions.
class CalledDevice final : public HapticDevice {
 public:
  CalledDevice(const TandemDeviceFunctions& functions, const DeviceCapabilities& limits)
      : functions_(functions), limits_(limits) {}

  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override { return limits_; }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    DeviceSample sample;
    Triple p{}, v{};
    sample.valid = functions_.read(functions_.user, now, p.data(), v.data()) != 0;
    sample.hip = {{p[0], p[1], p[2]}, {v[0], v[1], v[2]}};
    return sample;
  }
  void write(const Vec3& f_W) noexcept override {
    const Triple f{f_W.x(), f_W.y(), f_W.z()};
    functions_.write(functions_.user, f.data());
  }

 private:
  TandemDeviceFunctions functions_;
  DeviceCapabilities limits_;
};

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

}  // namespace

MovedDevice::MovedDevice(const Vec3& start_W, const DeviceCapabilities& limits)
    : limits_(limits), told_({{start_W.x(), start_W.y(), start_W.z()}, {}}) {}

void MovedDevice::move(const Vec3& p_W, const Vec3& v_W) noexcept {
  told_.write({{p_W.x(), p_W.y(), p_W.z()}, {v_W.x(), v_W.y(), v_W.z()}});
}

DeviceSample MovedDevice::read(double now) noexcept {
  if (told_.isNew()) since_ = now;
  const Motion& motion = told_.read();
  const double age = std::clamp(now - since_, 0.0, kGoesOn);
  const bool goes_on = age < kGoesOn;
  const Vec3 v_W = toVec3(motion.v_W);
  return {{toVec3(motion.p_W) + age * v_W, goes_on ? v_W : Vec3(Vec3::Zero())}, true};
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
    if (!functions.read) refuseNull("functions.read");
    if (!functions.write) refuseNull("functions.write");
    out = Shells<TandemDevice>::all().wrap(std::make_unique<Device>(
        std::make_unique<CalledDevice>(functions, readLimits("called", limits))));
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
