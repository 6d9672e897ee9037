#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// What a leg is made of [m]; only these combinations of the drawing's lengths matter.
struct FalconGeometry {
  double arm = 0.060;               ///< a: from the motor's axis to the elbow
  double rod = 0.1025;              ///< b: of the parallelogram
  double rod_ends = 0.0225;         ///< d + e: from the elbow, and to the grip
  double base_less_grip = 0.02557;  ///< r - c: radii of the base's axes and the grip's
  double aside = 0.00191;           ///< s - f: of the leg's plane
  /// Of the legs 1 top, 2 right, 3 left, seen from the front [rad].
  std::array<double, 3> azimuths = {1.8325957145940461, -0.26179938779914941, -2.3561944901923448};
};

/// A Falcon's counts by torque are not published; fits to traces of the maker's driver give 3500 to
/// 4500, and the smaller the value the smaller the force [1/(N m)].
inline constexpr double kUsualMotorsPerTorque = 4200.0;

/// The last word on a Falcon's force, whoever asks for it.
struct FalconForceLimits {
  double max_force = 8.0;    ///< [N], norm; direction kept. The maker gives 8.9 N
  double max_slew = 2000.0;  ///< [N/s]: fastest change, at most so much a millisecond
  double ramp_in = 0.5;      ///< over which force comes in once it may [s]
  double hold = 0.05;        ///< a force that is not renewed begins to fade after this [s]...
  double fade = 0.04;        ///< ...and is zero after this [s]
};

/// How patiently a Falcon is booted. Real ones often fail the first times.
struct BootSettings {
  int tries = 10;             ///< of the whole load, >= 1
  double back_off = 0.1;      ///< after the first failed try [s], doubled each time...
  double max_back_off = 2;    ///< ...up to this [s]
  double probe_time = 0.15;   ///< how long to look for firmware that runs already [s]
  double call_period = 0.05;  ///< between calls of the boot loader [s]
  int calls = 20;             ///< of the boot loader, in one try
  double echo_time = 0.5;     ///< for the echo of a piece [s]
  double start_time = 1.0;    ///< for the firmware's first reply [s]
};

struct FalconSettings {
  FalconForceLimits force;
  /// What the motors make of a torque [1/(N m)]. Not published: see kUsualMotorsPerTorque. Raising
  /// it raises the force that is felt for a newton asked for.
  double motors_per_torque = kUsualMotorsPerTorque;
  Vec3 centre_D = Vec3(0.0, 0.0, 0.125);  ///< what is reported as the origin [m]
  double frame_period = 0.001;            ///< [s]; USB does not allow less
  double resend_time = 0.004;             ///< a frame without reply is given up after this [s]
  double reply_time = 0.020;              ///< without a reply for so long: fault, no force [s]
  double quiet_time = 0.06;     ///< after a fault, for replies that are still on their way [s]
  double firmware_time = 0.2;   ///< without a reply for so long: boot again [s]
  double recovery_time = 0.05;  ///< a fault is over after so long without trouble [s]
  double reboot_pause = 2.0;    ///< after a boot that failed [s]
  double fastest_hand = 3.0;    ///< a position that moved faster has jumped [m/s]
  BootSettings boot;
  /// SCHED_FIFO of FalconDevice's thread, 1 to 99, where the system grants it; 0: as the process
  /// has it, and a busy machine makes replies late. Above a HapticLoop's: it is short, and often
  /// waits.
  int thread_priority = 0;
};

/// Throws std::invalid_argument, naming the value and what is allowed, for one out of range.
void check(const FalconSettings& settings);

/// An image that has been looked through; empty: there is none.
struct FirmwareImage {
  std::vector<std::uint8_t> bytes;
  [[nodiscard]] bool isEmpty() const noexcept { return bytes.empty(); }
};

/// Reads and checks a file. Throws tandem::Error, one line with path and remedy.
[[nodiscard]] FirmwareImage readFirmware(const std::string& path);

/// An image that loads and does nothing, for the emulator and for tests: one block of `words`
/// pseudo-random words. A real Falcon must never be given it.
[[nodiscard]] FirmwareImage makeSyntheticFirmware(std::uint64_t seed, std::size_t words = 512);

}  // namespace tandem
#pragma GCC visibility pop
