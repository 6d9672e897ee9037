#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Lengths of a leg [m]. Only these combinations of the drawing's lengths matter.
struct FalconGeometry {
  double arm = 0.060;        ///< a: motor axis to elbow
  double rod = 0.1025;       ///< b: length of the parallelogram
  double rod_ends = 0.0225;  ///< d + e: offsets of the rod's ends at the elbow and at the grip
  double base_less_grip = 0.02557;  ///< r - c: radius of the base's axes less the grip's
  double aside = 0.00191;           ///< s - f: sideways offset of the leg's plane
  /// Azimuths of legs 1 top, 2 right and 3 left, seen from the front [rad].
  std::array<double, 3> azimuths = {1.8325957145940461, -0.26179938779914941, -2.3561944901923448};
};

/// Motor counts per torque [1/(N m)]. The maker does not publish it. Fits to traces of the maker's
/// driver give 3500 to 4500. A smaller value gives a smaller force.
inline constexpr double kUsualMotorsPerTorque = 4200.0;

/// Limits of a Falcon's force, applied last.
struct FalconForceLimits {
  double max_force = 8.0;    ///< [N], norm; direction is kept. The maker states 8.9 N
  double max_slew = 2000.0;  ///< fastest change of the force [N/s], applied per millisecond
  double ramp_in = 0.5;      ///< time of the ramp from zero to full force [s]
  double hold = 0.05;        ///< a force that is not renewed begins to fade after this [s]
  double fade = 0.04;        ///< a fading force reaches zero after this [s]
};

/// Retries and timeouts of booting a Falcon. Real devices often fail the first times.
struct BootSettings {
  int tries = 10;             ///< attempts at the whole boot, >= 1
  double back_off = 0.1;      ///< pause after the first failed try [s]; doubles each time
  double max_back_off = 2;    ///< longest pause between tries [s]
  double probe_time = 0.15;   ///< time to look for firmware that already runs [s]
  double call_period = 0.05;  ///< time between calls of the boot loader [s]
  int calls = 20;             ///< calls of the boot loader in one try
  double echo_time = 0.5;     ///< time to wait for the echo of a piece [s]
  double start_time = 1.0;    ///< time to wait for the firmware's first reply [s]
};

struct FalconSettings {
  FalconForceLimits force;
  /// Motor counts per torque [1/(N m)]; see kUsualMotorsPerTorque. Raising it raises the force that
  /// the hand feels per newton asked for.
  double motors_per_torque = kUsualMotorsPerTorque;
  Vec3 centre_D = Vec3(0.0, 0.0, 0.125);  ///< point of the device reported as the origin [m]
  double frame_period = 0.001;            ///< time between frames [s]; USB allows no less
  double resend_time = 0.004;             ///< a frame without reply is given up after this [s]
  double reply_time = 0.020;              ///< no reply for this long is a fault: no force [s]
  double quiet_time = 0.06;               ///< after a fault, time to drain late replies [s]
  double firmware_time = 0.2;             ///< no reply for this long: boot again [s]
  double recovery_time = 0.05;            ///< a fault ends after this long without trouble [s]
  double reboot_pause = 2.0;              ///< pause after a failed boot [s]
  double fastest_hand = 3.0;              ///< a position that moves faster counts as a jump [m/s]
  BootSettings boot;
  /// SCHED_FIFO priority of FalconDevice's thread, 1 to 99, where the system grants it. 0 keeps the
  /// scheduling of the process; replies are then late on a busy machine. Choose it above a
  /// HapticLoop's: the thread works briefly and often waits.
  int thread_priority = 0;
};

/// Throws std::invalid_argument with the name of a value out of range and the allowed range.
void check(const FalconSettings& settings);

/// A firmware image that passed the checks. Empty means no image.
struct FirmwareImage {
  std::vector<std::uint8_t> bytes;
  [[nodiscard]] bool isEmpty() const noexcept { return bytes.empty(); }
};

/// Reads and checks a file. Throws tandem::Error with path and remedy in one line.
[[nodiscard]] FirmwareImage readFirmware(const std::string& path);

/// Makes an image that loads and does nothing: one block of `words` pseudo-random words. For the
/// emulator and tests. Never load it into a real Falcon.
[[nodiscard]] FirmwareImage makeSyntheticFirmware(std::uint64_t seed, std::size_t words = 512);

}  // namespace tandem
#pragma GCC visibility pop
