#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tandem/falcon/hid_port.h"

namespace tandem {

/// Layout of a SpaceMouse's reports.
enum class SpaceMouseLayout {
  kOld,  ///< alternating translation and rotation, 7 bytes each
  kNew   ///< translation and rotation in 13 bytes
};

/// Report descriptor of an emulated SpaceMouse: a multi-axis controller with two buttons.
[[nodiscard]] std::vector<std::uint8_t> makeSpaceMouseDescriptor(SpaceMouseLayout layout);

/// Emulates the reports of a SpaceMouse at a given time. While the cap is displaced there is a
/// report every 8 ms. At rest there are three reports of zero, then silence. Buttons are reported
/// when they change.
class SpaceMouseEmulator {
 public:
  static constexpr double kPeriod = 0.008;  ///< between reports [s]

  explicit SpaceMouseEmulator(SpaceMouseLayout layout) : layout_(layout) {}

  /// Sets the displacement in counts, -350 to 350 for most units: x y z rx ry rz.
  void move(const std::array<std::int16_t, 6>& counts) noexcept;
  void press(std::uint16_t buttons) noexcept;

  /// Returns the next report due at `now` [s]. Call it until it returns nothing.
  [[nodiscard]] std::optional<HidReport> next(double now) noexcept;

 private:
  [[nodiscard]] HidReport makeMotion() noexcept;

  SpaceMouseLayout layout_;
  std::array<std::int16_t, 6> counts_{};
  std::uint16_t buttons_ = 0;
  bool buttons_changed_ = false, tells_turn_ = false;
  int remaining_ = 0;  ///< reports of zero left before silence; -1: the cap is displaced
  double due_ = 0.0;   ///< time of the next report about the cap [s]
};

}  // namespace tandem
