#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "tandem/falcon/event_port.h"
#include "tandem/falcon/gamepad_device.h"

/// \file
/// Events of a gamepad, joystick or wheel, as Linux reports them:
///
///     ABS_X ABS_Y             left stick, or the stick: right, towards the user
///     ABS_RY, or else ABS_RZ  right stick: down
///     ABS_Z ABS_RZ            left and right trigger: down, up; they rest at their low end
///     ABS_HAT0Y               directional pad or hat: down
///
/// An axis that rests at an end of its range is no stick: a trigger or a pedal. Nothing from the
/// device is trusted: a range without extent leaves the axis out, and places are clamped.
namespace tandem {

enum class GamepadNews {
  kPart,    ///< more events of the same report follow
  kReport,  ///< a report is complete
  kLost     ///< events were lost: read the state anew
};

/// Sticks and buttons, accumulated from events. Pure but for the port; real-time safe.
class GamepadAxes {
 public:
  /// Reads ranges and places from the device, and decides what each axis is for. The device should
  /// be at rest.
  explicit GamepadAxes(EventPort& port) noexcept;

  [[nodiscard]] GamepadNews take(const InputEvent& event) noexcept;

  /// Reads all places and buttons anew.
  void readAll(EventPort& port) noexcept;

  [[nodiscard]] GamepadState state() const noexcept;
  /// True if the device has a stick or wheel.
  [[nodiscard]] bool hasStick() const noexcept { return axes_[kX].is_there; }

 private:
  enum Axis : std::size_t { kX, kY, kZ, kRx, kRy, kRz, kHat, kAxes };
  struct Place {
    bool is_there = false;
    double low = 0.0, high = 1.0, value = 0.0;
    [[nodiscard]] double part() const noexcept;  ///< -1 at the low end to 1 at the high end
    [[nodiscard]] bool isCentred() const noexcept;
    [[nodiscard]] bool isAtLowEnd() const noexcept;
  };

  [[nodiscard]] static std::optional<std::size_t> findAxis(std::uint16_t code) noexcept;
  void chooseRoles(Feel feel) noexcept;
  void setButton(std::uint16_t code, bool is_pressed) noexcept;
  [[nodiscard]] double computeUp() const noexcept;

  std::array<Place, kAxes> axes_;
  std::size_t down_ = kAxes;  ///< axis of the right stick; kAxes: none
  bool has_back_ = false, has_triggers_ = false;
  bool is_lost_ = false;  ///< events until the next report are stale
  std::uint32_t buttons_ = 0;
};

}  // namespace tandem
