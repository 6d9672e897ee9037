#include "bench/stress/stress_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem::demos::bench {
namespace {

constexpr double kMargin = 2.0;

/// A proxy's target stands still between two packets and then leaps by v T. Each leap gives the
/// spring K (v T)^2 / 2. That is more than the user has if K T^2 is more than the mass. Its damper
/// must absorb the rest, as for a sampled wall.
bool isFollowingPassive(const StressCase& one) {
  CouplerGains spring = one.coordination;
  spring.stiffness *= kMargin;
  spring.damping = 0.0;
  return isSampledContactPassive(one.coordination.damping + one.proxy_damping, spring,
                                 1.0 / one.packet_rate);
}

}  // namespace

bool isSampledContactPassive(double device_damping, const CouplerGains& wall, double period) {
  return device_damping > 0.5 * wall.stiffness * period + wall.damping;
}

double computeLongestDelay(const CouplerGains& coupler, double mass) {
  if (!(coupler.stiffness > 0.0)) return std::numeric_limits<double>::infinity();
  const double w = std::sqrt(2.0 * coupler.stiffness / mass);
  return 2.0 * std::atan2(coupler.damping * w, coupler.stiffness) / w;
}

bool isAnalysedStable(const StressCase& one) {
  if (one.users[1].is_scripted) return true;
  if (one.network.loss > 0.0 || one.network.jitter > 0.0 || one.network.reorder > 0.0 ||
      one.network.duplicate > 0.0)
    return false;
  // A body that follows packets exactly gives unlimited energy.
  if (one.scheme == "kinematic_proxy") return false;
  // A packet is up to one packet period older than the delay.
  const double oldest = one.network.delay + 1.0 / one.packet_rate;
  // A device touches at most a shared body and the other user's proxy. Through the proxy the force
  // goes round by the other user. It returns after twice the delay and the proxies' lag.
  CouplerGains wall = one.contact;
  wall.stiffness *= 2.0 * kMargin;
  wall.damping *= 2.0 * kMargin;
  double late = 0.0;
  if (one.scheme == "remote_dynamic_proxy") {
    if (!isFollowingPassive(one)) return false;
    late = 2.0 * (oldest + std::sqrt(one.proxy_mass / one.coordination.stiffness));
  }
  for (const StressUser& user : one.users)
    if (!isSampledContactPassive(user.device_damping, wall, 1.0 / one.haptic_rate + 2.0 * late))
      return false;
  for (const StressBody& body : one.bodies)
    if (!(kMargin * oldest < computeLongestDelay(one.coordination, body.mass))) return false;
  return true;
}

}  // namespace tandem::demos::bench
