#pragma once

#include <atomic>
#include <memory>

#include "tandem/falcon/emulated_falcon_port.h"

namespace tandem::demos {

/// What a simulated user does once the device is homed.
enum class UserWish {
  kRest,  ///< holds the grip softly in the middle
  kDip,   ///< and goes down and up again, as if to press on something
  kReach  ///< and goes forward and back
};

/// A Falcon in this process that a simulated user holds, for who has none: bytes go over a pseudo
/// terminal, the firmware is loaded, and the hand pulls the grip out and pushes it in until the
/// device is homed.
class EmulatedUser {
 public:
  static constexpr double kStiffness = 300.0;  ///< of the hand [N/m]
  static constexpr double kDip = 0.03;         ///< [m]
  static constexpr double kDipPeriod = 2.0;    ///< [s]

  explicit EmulatedUser(UserWish wish);
  ~EmulatedUser();

  [[nodiscard]] const std::string& path() const noexcept { return port_->path(); }

  /// The user may stop homing; wait-free, and at once but for the first time.
  void tellHomed() noexcept;

  /// What the motors push the grip with now, in the device's frame [N].
  [[nodiscard]] Vec3 pushNow();
  /// The most they ever did [N].
  [[nodiscard]] double mostFelt();

 private:
  class Helper;

  std::atomic<double> homed_at_{-1.0};  ///< by the emulator's clock [s]
  std::unique_ptr<EmulatedFalconPort> port_;
};

}  // namespace tandem::demos
