#pragma once

#include <stdexcept>

#include "devices/fake_hid_port.h"
#include "falcon/src/hid/raw_hid_report.h"

namespace tandem::test {

/// The bytes of a raw HID device whose grip is held at a place.
class RawHidEmulator {
 public:
  void holdAt(const Vec3& p_D) {
    const auto angles = kinematics_.computeAngles(p_D);
    if (!angles) throw std::invalid_argument("the legs do not reach there");
    for (int i = 0; i < 3; ++i)
      state_.counts[static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(std::lround(countsOfAngle((*angles)[i])));
  }
  /// Shifts an arm's counts by `counts` from now on.
  void turn(std::size_t leg, int counts) {
    state_.counts[leg] = static_cast<std::int16_t>(state_.counts[leg] + counts);
  }
  void setHomed(bool is_homed) { state_.homed = is_homed ? 7 : 3; }

  /// The next state, `step_us` after the last one.
  Bytes next(std::uint32_t step_us = 1000) {
    ++state_.number;
    state_.time_us += step_us;
    const RawHidBytes bytes = encodeRawState(state_);
    return {bytes.begin(), bytes.end()};
  }

  /// The command in an output report that begins with the report number 0.
  static RawHidCommand decode(const Bytes& output) {
    if (output.empty() || output[0] != 0) throw std::invalid_argument("no report without an id");
    const auto command = decodeRawCommand(output.data() + 1, output.size() - 1);
    if (!command) throw std::invalid_argument("no command");
    return *command;
  }

 private:
  FalconKinematics kinematics_;
  RawHidState state_{0, {}, 7, 0, 0};
};

}  // namespace tandem::test
