#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "tandem/falcon/gamepad_device.h"

#include "gamepad/feel_player.h"
#include "gamepad/gamepad_axes.h"

namespace tandem {

/// A gamepad while it is plugged in: its port, its axes and its effect. One thread uses it.
class GamepadLine {
 public:
  /// Outcome of listening.
  struct Heard {
    bool is_gone = false;
    std::uint64_t reports = 0;  ///< whole ones
    std::uint64_t dropped = 0;  ///< reports that followed a loss of events
  };

  /// Throws tandem::Error if there is no port, or the device has no stick.
  explicit GamepadLine(std::unique_ptr<EventPort> port);

  /// Waits up to `wait` [s] for events, and takes some.
  [[nodiscard]] Heard listen(double wait) noexcept;

  /// Renders the force `f_D` [N] in the user's frame; `max_force` [N] is full strength.
  FeelNews render(const Vec3& f_D, double max_force, double now) noexcept;

  [[nodiscard]] const std::string& name() const noexcept { return port_->name(); }
  [[nodiscard]] Feel feel() const noexcept { return port_->feel(); }
  /// As of the last whole report.
  [[nodiscard]] const GamepadState& state() const noexcept { return state_; }

 private:
  void takeEvent(const InputEvent& event, Heard& heard) noexcept;

  std::unique_ptr<EventPort> port_;
  GamepadAxes axes_;
  FeelPlayer player_;  ///< ends before its port
  GamepadState state_;
};

}  // namespace tandem
