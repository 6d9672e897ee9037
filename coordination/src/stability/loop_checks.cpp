#include "stability/loop_checks.h"

#include <cmath>
#include <stdexcept>

#include "bad_value.h"

namespace tandem::stability {
namespace {

void check(const char* name, double value, bool is_good, const char* allowed) {
  if (!is_good || !std::isfinite(value)) throwBadValue(name, value, allowed);
}

void checkPositive(const char* name, double value) {
  check(name, value, value > 0.0, "a finite number above 0");
}

void checkNotNegative(const char* name, double value) {
  check(name, value, value >= 0.0, "a finite number, 0 or more");
}

void checkUsers(const LoopSettings& s) {
  if (s.areUsersAlike()) return;
  check("users", s.users, s.users <= kMostUnlikeUsers,
        "at most 4 if they differ; more take too long");
  check("size of each", static_cast<double>(s.each.size()),
        s.each.size() == static_cast<std::size_t>(s.users), "one for each of `users`, or 0");
  for (const LoopUser& user : s.each) {
    checkPositive("each.device_mass", user.device_mass);
    checkNotNegative("each.device_damping", user.device_damping);
    checkNotNegative("each.contact_stiffness", user.contact_stiffness);
    checkNotNegative("each.contact_damping", user.contact_damping);
    check("size of each.delays", static_cast<double>(user.delays.size()),
          user.delays.empty() || user.delays.size() == s.each.size(),
          "one for each of `users`, or 0");
    for (const double delay : user.delays)
      check("each.delays", delay, delay >= 0.0 && delay <= 1.0, "parts of `delay`, 0 to 1");
  }
}

}  // namespace

void checkLoop(const LoopSettings& s) {
  check("users", s.users, s.users >= 2, "2 or more");
  checkPositive("object_mass", s.object_mass);
  checkNotNegative("object_damping", s.object_damping);
  checkNotNegative("contact.stiffness", s.contact.stiffness);
  checkNotNegative("contact.damping", s.contact.damping);
  checkNotNegative("coordination.stiffness", s.coordination.stiffness);
  checkNotNegative("coordination.damping", s.coordination.damping);
  checkPositive("proxy_mass", s.proxy_mass);
  checkNotNegative("proxy_damping", s.proxy_damping);
  checkPositive("device_mass", s.device_mass);
  checkNotNegative("device_damping", s.device_damping);
  checkNotNegative("hand.mass", s.hand.mass);
  checkNotNegative("hand.stiffness", s.hand.stiffness);
  checkNotNegative("hand.damping", s.hand.damping);
  checkPositive("haptic_rate", s.haptic_rate);
  check("packet_rate", s.packet_rate, s.packet_rate > 0.0 && s.packet_rate <= s.haptic_rate,
        "above 0, at most the haptic rate");
  check("delay", s.delay, s.delay >= 0.0 && s.delay <= kLongestDelay,
        "0 to 0.5 s; packets on their way are states, and more of them take too long");
  checkUsers(s);
  if (!s.has_object && s.stand_in == StandInKind::kNone)
    throw std::invalid_argument(
        "has_object = 0: users who are felt through shared objects only need one");
}

void checkPhase(double phase) { check("phase", phase, phase >= 0.0 && phase <= 1.0, "0 to 1"); }

}  // namespace tandem::stability
