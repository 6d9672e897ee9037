#include "device/drivers.h"

#include <utility>

#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/falcon_device.h"
#include "tandem/falcon/raw_hid_device.h"
#include "tandem/falcon/simulated_device.h"
#include "tandem/falcon/space_mouse_device.h"

#include "device/gamepad_driver.h"
#include "device/plugged_in.h"
#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

using Kind = DeviceSpec::Kind;

constexpr int kThreadPriority = 85;  // above a HapticLoop's

FalconSettings makeFalconSettings(const DeviceOptions& options) {
  FalconSettings settings;
  settings.force.max_force = options.max_force;
  settings.motors_per_torque = options.motors_per_torque;
  settings.thread_priority = kThreadPriority;
  return settings;
}

/// The emulator is a thread of this process, which a busy machine may delay for long.
FalconSettings makePatient(FalconSettings settings) {
  settings.reply_time = 0.3;
  settings.quiet_time = 0.3;
  settings.firmware_time = 1.5;
  settings.boot.probe_time = 0.3;
  settings.boot.echo_time = 1.0;
  return settings;
}

FirmwareImage readImage(const DeviceOptions& options) {
  if (!options.firmware) return {};
  try {
    return readFirmware(*options.firmware);
  } catch (const Error& error) {
    throw UsageError(std::string("--firmware ") + error.what());
  }
}

/// Opens at once, so that the caller gets the error; after a loss, the device's thread opens again.
/// The transport waits in a shared place because a std::function must be copyable.
OpenTransport openNow(const OpenTransport& open) {
  auto first = std::make_shared<std::unique_ptr<ByteTransport>>(open());
  return [first, open] { return *first ? std::exchange(*first, nullptr) : open(); };
}

Driver makeFalcon(const FalconSettings& settings, FirmwareImage image, const OpenTransport& open) {
  check(settings);
  auto device = std::make_unique<FalconDevice>(settings, std::move(image), openNow(open));
  Driver driver;
  driver.report = [falcon = device.get()] { return describe(falcon->status()); };
  driver.pressed = [falcon = device.get()] { return falcon->buttons(); };
  driver.device = std::move(device);
  return driver;
}

Driver makeEmulated(const DeviceOptions& options, UserWish wish) {
  auto user = std::make_unique<EmulatedUser>(wish);
  FirmwareImage image = options.firmware ? readImage(options) : makeSyntheticFirmware(1);
  Driver driver = makeFalcon(makePatient(makeFalconSettings(options)), std::move(image),
                             [path = user->path()] { return openTty(path); });
  driver.emulated = std::move(user);
  return driver;
}

/// A hand that moves like the emulated Falcon's, but needs no homing.
std::unique_ptr<Hand> makeSimulatedHand(UserWish wish) {
  std::vector<Waypoint> way = {{0.0, Vec3::Zero()}};
  const Vec3 goal =
      EmulatedUser::kDip * (wish == UserWish::kDip ? Vec3(0.0, -1.0, 0.0) : Vec3(0.0, 0.0, -1.0));
  // The hand dips for an hour, then rests.
  for (int i = 0; wish != UserWish::kRest && i < 1800; ++i) {
    const double t = 0.5 + EmulatedUser::kDipPeriod * i;
    way.push_back({t, Vec3::Zero()});
    way.push_back({t + 0.5 * EmulatedUser::kDipPeriod, goal});
  }
  return makeMinimumJerkHand(std::move(way), EmulatedUser::kStiffness, 8.0);
}

/// A device whose time begins at its first reading.
class SimulatedFromNow final : public HapticDevice {
 public:
  explicit SimulatedFromNow(UserWish wish) : device_({}, makeSimulatedHand(wish)) {}
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override {
    return device_.capabilities();
  }
  [[nodiscard]] DeviceSample read(double now) noexcept override {
    if (!begin_) begin_ = now;
    return device_.read(now - *begin_);
  }
  void write(const Vec3& f_W) noexcept override { device_.write(f_W); }

 private:
  SimulatedDevice device_;
  std::optional<double> begin_;
};

Driver makeSimulated(UserWish wish) {
  Driver driver;
  driver.device = std::make_unique<SimulatedFromNow>(wish);
  driver.report = [] {
    DeviceReport report;
    report.state = "ready";
    report.is_ready = true;
    return report;
  };
  return driver;
}

/// The report that all HID devices share.
template <typename Status>
DeviceReport describeHid(const Status& status) {
  DeviceReport report = describePlugged(status);
  report.counters = {{"reports", status.counters.reports},
                     {"refused", status.counters.refused},
                     {"written", status.counters.written},
                     {"write misses", status.counters.write_misses},
                     {"losses", status.counters.losses}};
  return report;
}

Driver makeSpaceMouse(const std::string& path) {
  auto device = std::make_unique<SpaceMouseDevice>([path] { return openMouse(path); });
  Driver driver;
  driver.report = [mouse = device.get()] { return describeHid(mouse->status()); };
  driver.device = std::move(device);
  return driver;
}

Driver makeRawHid(const std::string& path, const DeviceOptions& options) {
  RawHidSettings settings;
  settings.max_force = options.max_force;
  auto device = std::make_unique<RawHidDevice>([path] { return openRawHid(path); }, settings);
  Driver driver;
  driver.report = [hid = device.get()] {
    const RawHidStatus status = hid->status();
    DeviceReport report = describeHid(status);
    report.homed = status.state.homed;
    if (status.is_connected && status.state.homed != 7) report.state = "unhomed";
    report.is_ready = report.state == "ready";
    return report;
  };
  driver.device = std::move(device);
  return driver;
}

}  // namespace

Driver openDriver(const DeviceSpec& spec, const DeviceOptions& options, UserWish wish) {
  const FalconSettings settings = makeFalconSettings(options);
  switch (spec.kind) {
    case Kind::kFalconUsb:
      return makeFalcon(settings, readImage(options),
                        [serial = spec.place] { return openFalconUsb(serial); });
    case Kind::kFalconTty:
      return makeFalcon(settings, readImage(options),
                        [path = spec.place] { return openTty(path); });
    case Kind::kFalconFt260:
      return makeFalcon(settings, readImage(options), [] { return openFalconFt260(); });
    case Kind::kEmulated:
      return makeEmulated(options, wish);
    case Kind::kSimulated:
      return makeSimulated(wish);
    case Kind::kSpaceMouse:
      return makeSpaceMouse(spec.place);
    case Kind::kRawHid:
      return makeRawHid(spec.place, options);
    case Kind::kGamepad:
      return makeGamepadDriver([path = spec.place] { return openGamepad(path); }, options);
  }
  throw Error("no such device");
}

}  // namespace tandem::demos
