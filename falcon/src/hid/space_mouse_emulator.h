#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/falcon/hid_port.h"

#pragma GCC visibility push(default)
namespace tandem {

/// How a SpaceMouse lays out its reports.
enum class SpaceMouseLayout {
  kOld,  ///< place and turn in turn, 7 bytes each
  kNew   ///< both in 13 bytes
};

/// Report descriptor of an emulated one: a multi-axis controller with two buttons.
[[nodiscard]] std::vector<std::uint8_t> makeSpaceMouseDescriptor(SpaceMouseLayout layout);

/// The bytes of a SpaceMouse, in a time that is told: a report every 8 ms while the cap is moved,
/// then three times zero, then silence. Buttons are told when they change.
class SpaceMouseEmulator {
 public:
  static constexpr double kPeriod = 0.008;  ///< between reports [s]

  explicit SpaceMouseEmulator(SpaceMouseLayout layout) : layout_(layout) {}

  /// Displacement in counts, -350 to 350 for most units: x y z rx ry rz.
  void move(const std::array<std::int16_t, 6>& counts) noexcept;
  void press(std::uint16_t buttons) noexcept;

  /// The next report that is due at `now` [s], if one is; to be asked until none is.
  [[nodiscard]] std::optional<HidReport> next(double now) noexcept;

 private:
  [[nodiscard]] HidReport makeMotion() noexcept;

  SpaceMouseLayout layout_;
  std::array<std::int16_t, 6> counts_{};
  std::uint16_t buttons_ = 0;
  bool buttons_changed_ = false, tells_turn_ = false;
  int remaining_ = 0;  ///< reports until it is silent, while the cap is at rest
  double due_ = 0.0;   ///< when the next report about the cap is [s]
};

}  // namespace tandem
#pragma GCC visibility pop
