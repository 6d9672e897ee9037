#pragma once

#include "tandem/falcon/falcon_boot.h"
#include "tandem/falcon/falcon_force_gate.h"
#include "tandem/falcon/falcon_kinematics.h"

#pragma GCC visibility push(default)
namespace tandem {

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

}  // namespace tandem
#pragma GCC visibility pop
