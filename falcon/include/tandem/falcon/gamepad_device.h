#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "tandem/falcon/event_port.h"
#include "tandem/falcon/haptic_device.h"

#pragma GCC visibility push(default)
namespace tandem {

class GamepadHand;
class GamepadStream;

/// Motion of a hand by sticks, its force, and pauses before a device is opened again.
struct GamepadSettings {
  double speed = 0.15;      ///< of the hand at full displacement of a stick [m/s], > 0
  double dead_zone = 0.12;  ///< fraction of the full displacement that counts as zero, 0 to below 1
  double smoothing = 0.03;  ///< time constant of that velocity [s], > 0; more is smoother and later
  double max_force = 8.0;   ///< most that is rendered [N], > 0; gives full rumble or force
  Vec3 start_W = Vec3::Zero();           ///< start of the hand, the middle of its box [m]
  Vec3 workspace = Vec3::Constant(0.3);  ///< half extents of the box [m], > 0
  double travel = 0.15;  ///< way of the hand for a full displacement of a stick with force [m], > 0
  Quat q_WD = Quat(1.0, 0.0, 0.0, 0.0);  ///< user's frame (x right, y up, z back) to W
  double first_retry = 0.1;              ///< pause before the first attempt to reopen [s], > 0
  double longest_retry = 2.0;  ///< longest pause [s]; the pause doubles after each attempt
};

/// Sticks and buttons of a gamepad or joystick.
struct GamepadState {
  std::array<double, 3> sticks{};  ///< right, up, towards the user; each -1 to 1
  std::uint32_t buttons = 0;       ///< bit i: button i of the gamepad's or joystick's block
};

/// Buttons of a gamepad by their places, as bits of GamepadState. `kSouthButton` is A or a cross,
/// and a joystick's trigger.
enum GamepadButton : std::uint8_t {
  kSouthButton = 0x01,
  kEastButton = 0x02,
  kNorthButton = 0x08,
  kWestButton = 0x10,
  kLeftShoulder = 0x40,
  kRightShoulder = 0x80
};

struct GamepadCounters {
  std::uint64_t reports = 0;  ///< groups of events received
  std::uint64_t dropped = 0;  ///< times that the kernel lost events; the state is then read anew
  std::uint64_t uploads = 0;  ///< times that the effect was uploaded or updated
  std::uint64_t refused = 0;  ///< of these, refused by the device
  std::uint64_t losses = 0;   ///< times that the device was unplugged
};

/// Status of a gamepad besides its hand.
struct GamepadStatus {
  GamepadState state;
  bool is_connected = false;
  Feel feel = Feel::kNothing;
  std::string name, trouble;
  GamepadCounters counters;
};

/// A gamepad, joystick or wheel as a haptic device. A simulated hand (MouseDevice) pulls a
/// simulated handle, which the site pushes. The hand's target is moved in one of two ways:
///
///   pad, joystick     velocity of the target = speed x displacement of the sticks
///   stick with force  target = start + travel x displacement; up and down by the hat
///
/// The target stays within the box, and so near to the handle that the hand never winds up against
/// a wall. Rumble has a strength of |f| / max_force. A stick with force is pushed by the level part
/// of f: max_force is its full strength. A device of neither kind is felt by the eye only.
///
/// A thread of its own reads events and updates the one effect at 100 Hz. Force ends 0.1 s after
/// the last write(), and by itself in the device a second after the thread stops. An unplugged
/// device reads as not valid until it is back. read() and write() are wait-free and do not
/// allocate.
class GamepadDevice final : public HapticDevice {
 public:
  /// Throws what `open` throws. Throws std::invalid_argument with the setting's name if one is out
  /// of range.
  explicit GamepadDevice(EventOpener open, const GamepadSettings& settings = {});
  ~GamepadDevice() override;

  /// Name "gamepad", 3 degrees of freedom, max_force and the workspace.
  [[nodiscard]] const DeviceCapabilities& capabilities() const noexcept override;

  /// Not valid while unplugged, and after half a second without a sign of the device's thread.
  [[nodiscard]] DeviceSample read(double now) noexcept override;
  void write(const Vec3& f_W) noexcept override;

  /// Buttons pressed at the last read. Wait-free, for any thread.
  [[nodiscard]] std::uint32_t buttons() const noexcept {
    return buttons_.load(std::memory_order_relaxed);
  }

  /// For the thread that reads. Takes a lock and allocates.
  [[nodiscard]] GamepadStatus status();

 private:
  DeviceCapabilities capabilities_;
  Quat q_DW_;
  std::atomic<std::uint32_t> buttons_{0};
  std::unique_ptr<GamepadHand> hand_;
  std::unique_ptr<GamepadStream> stream_;
};

}  // namespace tandem
#pragma GCC visibility pop
