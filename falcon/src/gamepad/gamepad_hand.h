#pragma once

#include "tandem/falcon/gamepad_device.h"
#include "tandem/falcon/mouse_device.h"

#include "guard/passed_time.h"
#include "hid/rate_control.h"

// clang-format off
//
//   sticks --> RateControl --> target --> MouseDevice: cursor --> hand --> handle --> sample
//                   ^                                                        |  ^
//                   +---------------- no farther than the stretch -----------+  +---- force
//
// clang-format on

namespace tandem {

/// The hand of a GamepadDevice: sticks in, a pulled handle out, in the time that it is told. It
/// waits for nothing and does not allocate. Not thread safe.
class GamepadHand {
 public:
  /// Throws std::invalid_argument with the setting's name if one is out of range.
  explicit GamepadHand(const GamepadSettings& settings);

  /// Moves the hand on to `now` [s]. `is_held`: the place of the stick is that of the hand.
  [[nodiscard]] DeviceSample advance(double now, const GamepadState& state, bool is_held) noexcept;

  /// The hand while no device is there: it stands.
  [[nodiscard]] DeviceSample stand(double now) noexcept;

  void write(const Vec3& f_W) noexcept { mouse_.write(f_W); }

 private:
  [[nodiscard]] Vec3 moveTarget(const GamepadState& state, bool is_held, double step) noexcept;
  void keepTargetNear(const Vec3& handle_W, bool is_held) noexcept;

  GamepadSettings settings_;
  RateControl motion_;
  MouseDevice mouse_;
  double longest_stretch_;          ///< beyond it the hand pulls no more [m]
  falcon_detail::PassedTime time_;  ///< the mouse's clock
  PointState handle_;
};

}  // namespace tandem
