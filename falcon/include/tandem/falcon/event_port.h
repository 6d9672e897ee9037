#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace tandem {

/// One event of an input device. Numbers are those of Linux's `linux/input-event-codes.h`.
struct InputEvent {
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

/// Place and range of an absolute axis, as the device tells them. They may make no sense.
struct EventAxis {
  std::int32_t value = 0, low = 0, high = 0;
};

/// The kind of force feedback that a device has.
enum class Feel : std::uint8_t {
  kNothing,
  kRumble,  ///< two motors that shake; strength only
  kForce    ///< motors that push the stick, with a direction
};

/// The one effect that a device plays.
struct FeelEffect {
  Feel kind = Feel::kNothing;
  std::uint16_t level = 0;  ///< 0 to 0xFFFF for rumble, 0 to 0x7FFF for a force
  /// Side that the force comes from: 0 the user, 0x4000 left, 0x8000 beyond the stick, 0xC000
  /// right.
  std::uint16_t direction = 0;
};

/// An open input device of Linux (evdev). No call throws once it is open. One thread uses it.
class EventPort {
 public:
  virtual ~EventPort() = default;

  /// Name for messages: "Xbox pad (/dev/input/event5)".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;

  /// Waits up to `wait` [s] for events, and returns their number, at most `room`. Returns 0 if none
  /// came, a negative number if the device is gone.
  [[nodiscard]] virtual std::ptrdiff_t read(InputEvent* events, std::size_t room,
                                            double wait) noexcept = 0;

  /// The state of an absolute axis now; empty if the device has no such axis, or is gone.
  [[nodiscard]] virtual std::optional<EventAxis> readAxis(std::uint16_t code) noexcept = 0;

  /// True if the key or button is pressed now. False if there is none, or the device is gone.
  [[nodiscard]] virtual bool readKey(std::uint16_t code) noexcept = 0;

  /// The best effect that the device can play: rumble before force.
  [[nodiscard]] virtual Feel feel() const noexcept = 0;

  /// Uploads an effect, or updates the one with number `id`; -1: a new one. An effect ends by
  /// itself one second after it was last played. Returns its number, negative if the device refuses
  /// it.
  [[nodiscard]] virtual int upload(int id, const FeelEffect& effect) noexcept = 0;

  /// Starts an effect anew, or stops it. Returns false if the device refuses it.
  virtual bool play(int id, bool is_on) noexcept = 0;

  /// Stops and forgets an effect.
  virtual void erase(int id) noexcept = 0;
};

/// The remedy for an input node that may not be opened.
inline constexpr const char* kGamepadRights =
    "join the group input (sudo usermod -aG input $USER), or install the udev rule of Tandem";

/// Opens a device at the start and again after it was unplugged. Throws tandem::Error on failure.
using EventOpener = std::function<std::unique_ptr<EventPort>()>;

/// A gamepad, joystick or wheel that is plugged in.
struct GamepadAddress {
  std::string path;  ///< "/dev/input/event5"
  std::string name;  ///< as the device says; printable
  Feel feel = Feel::kNothing;
  bool may_open = false;  ///< this process may read and write the node
};

/// Lists gamepads, joysticks and wheels plugged in now, in the order of their numbers. It reads the
/// `system` folder only, so it needs no rights. Files that make no sense are passed over.
[[nodiscard]] std::vector<GamepadAddress> findGamepads(
    const std::string& system = "/sys/class/input", const std::string& nodes = "/dev/input");

/// Opens the input device at `path`, or the first gamepad that may be opened if `path` is empty.
/// Throws tandem::Error with the remedy.
[[nodiscard]] std::unique_ptr<EventPort> openGamepad(const std::string& path = "");

}  // namespace tandem
#pragma GCC visibility pop
