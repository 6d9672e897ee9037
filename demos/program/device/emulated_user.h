#pragma once

#include <atomic>
#include <memory>

#include "tandem/falcon/emulated_falcon_port.h"

namespace tandem::demos {

/// Motion of a simulated user once the device is homed.
enum class UserWish {
  kRest,  ///< holds the grip softly in the middle
  kDip,   ///< also moves down and up, as if to press an object
  kReach  ///< also moves forward and back
};

/// A Falcon in this process held by a simulated user, for users without a device. Bytes pass a
/// pseudo terminal, and the firmware is loaded. The hand pulls the grip out and pushes it in until
/// the device is homed.
class EmulatedUser {
 public:
  static constexpr double kStiffness = 300.0;  ///< stiffness of the hand [N/m]
  static constexpr double kDip = 0.03;         ///< [m]
  static constexpr double kDipPeriod = 2.0;    ///< [s]

  explicit EmulatedUser(UserWish wish);
  ~EmulatedUser();

  [[nodiscard]] const std::string& path() const noexcept { return port_->path(); }

  /// Tells the user to stop homing. Wait-free; all but the first call do nothing.
  void tellHomed() noexcept;

  /// Force of the motors on the grip now, in the device's frame [N].
  [[nodiscard]] Vec3 pushNow();
  /// Largest force of the motors so far [N].
  [[nodiscard]] double mostFelt();

 private:
  class Helper;

  std::atomic<double> homed_at_{-1.0};  ///< time by the emulator's clock [s]
  std::unique_ptr<EmulatedFalconPort> port_;
};

}  // namespace tandem::demos
