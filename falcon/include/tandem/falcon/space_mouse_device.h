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

/// How the displacement of a cap that springs back becomes the motion of a point.
struct RateControlSettings {
  double speed = 0.15;      ///< at full displacement along an axis [m/s], > 0
  double dead_zone = 0.05;  ///< part of the full displacement that is none, 0 to below 1
  double smoothing = 0.03;  ///< time constant of the velocity [s], > 0; more is smoother and later
  Vec3 start_W = Vec3::Zero();            ///< where the point begins, the middle of its box [m]
  Vec3 workspace = Vec3::Constant(0.15);  ///< half extents of the box that it stays in [m], > 0
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);   ///< from the user's frame (x right, y up, z back) to W
};

/// What the reports add up to.
struct SpaceMouseState {
  std::array<double, 6> axes{};  ///< x y z rx ry rz of the cap, as the device has them, -1 to 1
  std::uint32_t buttons = 0;     ///< bit i: button i is pressed
};

struct SpaceMouseSettings {
  RateControlSettings motion;
  /// A cap that says nothing for so long is taken for let go [s], > 0. It ends its motion by
  /// reports of zero; some models are silent while the hand holds still.
  double silence = 1.0;
  HidStreamSettings stream;  ///< write_period is 0: nothing is sent
};

/// What a SpaceMouse shows besides the point.
struct SpaceMouseStatus {
  SpaceMouseState state;
  bool is_connected = false;
  std::string name, trouble;
  HidStreamCounters counters;
};

/// A SpaceMouse as a hand without force: the cap's displacement is the velocity of the haptic
/// interface point (RateControl), so that a second user needs no haptic device. Turns of the cap
/// are in the status only. Unplugged it stops at once and reads as not valid until it is back.
///
/// read() runs in the time that it is told, of which a step counts 20 ms at most: after a site has
/// stood the point goes on from where it was. It and write() are wait-free. Neither allocates.
class SpaceMouseDevice final : public HapticDevice {
 public:
  /// Throws what `open` throws; std::invalid_argument, naming the value, for bad settings.
  explicit SpaceMouseDevice(HidOpener open, const SpaceMouseSettings& settings = {});
  ~SpaceMouseDevice() override;

  /// Name "SpaceMouse", 0 degrees of freedom and max_force 0: it renders none.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3&) noexcept override {}

  /// From the thread that reads; takes a lock and allocates.
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

/// Those plugged in now.
[[nodiscard]] std::vector<HidAddress> findSpaceMice();

/// Opens the one at `path`, or the first there is if that is empty. Throws tandem::Error with the
/// remedy. Both need tandem_devices.
[[nodiscard]] std::unique_ptr<HidPort> openSpaceMouse(const std::string& path = "");

}  // namespace tandem
#pragma GCC visibility pop
