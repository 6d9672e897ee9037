#include "tandem/falcon/falcon_settings.h"

#include <cmath>

#include "guard/settings_check.h"
#include "novint/falcon_force_gate.h"

namespace tandem {

void check(const FalconSettings& s) {
  using falcon_detail::require;
  const auto positive = [](double value, const char* name) {
    require(std::isfinite(value) && value > 0.0, name, value, "above 0");
  };
  require(s.force.max_force >= 0.0 && s.force.max_force <= 8.9, "max_force", s.force.max_force,
          "0 to 8.9 N");
  positive(s.force.max_slew, "max_slew");
  require(s.force.ramp_in >= 0.0 && std::isfinite(s.force.ramp_in), "ramp_in", s.force.ramp_in,
          "0 or more");
  positive(s.force.hold, "hold");
  positive(s.force.fade, "fade");
  require(s.motors_per_torque > 0.0 && s.motors_per_torque <= 20000.0, "motors_per_torque",
          s.motors_per_torque, "above 0, to 20000");
  require(s.centre_D.allFinite(), "centre_D", s.centre_D, "finite");
  positive(s.frame_period, "frame_period");
  positive(s.resend_time, "resend_time");
  positive(s.reply_time, "reply_time");
  require(s.quiet_time >= s.reply_time, "quiet_time", s.quiet_time, "reply_time or more");
  const double silence = s.reply_time + kLongestForceFade + 2.0 * s.quiet_time;
  require(s.firmware_time > silence, "firmware_time", s.firmware_time,
          "above reply_time, twice quiet_time and 0.03 s");
  positive(s.recovery_time, "recovery_time");
  positive(s.reboot_pause, "reboot_pause");
  positive(s.fastest_hand, "fastest_hand");
  require(s.thread_priority >= 0 && s.thread_priority <= 99, "thread_priority", s.thread_priority,
          "0 to 99");
  require(s.boot.tries >= 1, "boot.tries", s.boot.tries, "1 or more");
  require(s.boot.calls >= 1, "boot.calls", s.boot.calls, "1 or more");
  positive(s.boot.back_off, "boot.back_off");
  positive(s.boot.max_back_off, "boot.max_back_off");
  positive(s.boot.probe_time, "boot.probe_time");
  positive(s.boot.call_period, "boot.call_period");
  positive(s.boot.echo_time, "boot.echo_time");
  positive(s.boot.start_time, "boot.start_time");
}

}  // namespace tandem
