#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tandem/falcon/haptic_device.h"
#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

class HidStream;
class RateControl;

/// Mapping from the displacement of a self-centring cap to the motion of a point and a wrist.
struct RateControlSettings {
  double speed = 0.15;      ///< at full displacement along an axis [m/s], > 0
  double turn_speed = 1.5;  ///< at full displacement about an axis [rad/s], >= 0; 0: no wrist
  double dead_zone = 0.05;  ///< fraction of the full displacement that counts as zero, 0 to below 1
  double smoothing = 0.03;  ///< time constant of the velocity [s], > 0; more is smoother and later
  Vec3 start_W = Vec3::Zero();            ///< start of the point, the middle of its box [m]
  Vec3 workspace = Vec3::Constant(0.15);  ///< half extents of the point's box [m], > 0
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);   ///< user's frame (x right, y up, z back) to W
};

/// State accumulated from the reports.
struct SpaceMouseState {
  std::array<double, 6> axes{};  ///< x y z rx ry rz of the cap in the device's axes, -1 to 1
  std::uint32_t buttons = 0;     ///< bit i: button i is pressed
};

struct SpaceMouseSettings {
  RateControlSettings motion;
  /// The cap counts as released after this long without a report [s], > 0. A cap normally ends its
  /// motion by reports of zero. Some models stay silent while the hand holds still.
  double silence = 1.0;
  HidStreamSettings stream;  ///< write_period is 0: nothing is sent
};

/// Status of a SpaceMouse besides its point.
struct SpaceMouseStatus {
  SpaceMouseState state;
  bool is_connected = false;
  std::string name, trouble;
  HidStreamCounters counters;
};

/// A SpaceMouse as a hand without force: the cap's displacement sets the velocity of the haptic
/// interface point, its rotation that of the wrist (RateControl). A second user then needs no
/// haptic device. An unplugged device stops at once and reads as not valid until it is
/// back.
///
/// read() integrates over the time that it is told, at most 20 ms per step. After a pause of the
/// site the point thus continues from where it was. read() and write() are wait-free and do not
/// allocate.
class SpaceMouseDevice final : public HapticDevice {
 public:
  /// Throws what `open` throws. Throws std::invalid_argument with the value's name for bad
  /// settings.
  explicit SpaceMouseDevice(HidOpener open, const SpaceMouseSettings& settings = {});
  ~SpaceMouseDevice() override;

  /// Name "SpaceMouse", 0 degrees of freedom and max_force 0: it renders no force.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3&) noexcept override {}

  /// For the thread that reads. Takes a lock and allocates.
  [[nodiscard]] SpaceMouseStatus status();

 private:
  class Client;

  DeviceCapabilities capabilities_;
  std::unique_ptr<RateControl> motion_;
  double silence_;
  double time_ = 0.0, heard_at_ = 0.0;
  std::uint64_t heard_ = 0;
  bool was_read_ = false;
  std::unique_ptr<Client> client_;  // outlives the stream
  std::unique_ptr<HidStream> stream_;
};

/// Lists the SpaceMice plugged in now. Needs tandem_devices.
[[nodiscard]] std::vector<HidAddress> findSpaceMice();

/// Opens the one at `path`, or the first one if `path` is empty. Throws tandem::Error with the
/// remedy. Needs tandem_devices.
[[nodiscard]] std::unique_ptr<HidPort> openSpaceMouse(const std::string& path = "");

}  // namespace tandem
#pragma GCC visibility pop
