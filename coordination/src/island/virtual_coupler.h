#pragma once

#include "tandem/coordination/coupling_settings.h"
#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

[[nodiscard]] inline CouplerGains computeShare(const CouplerGains& gains, double share) noexcept {
  return {share * gains.stiffness, share * gains.damping};
}

/// Force that pulls `follower` towards `leader`, expressed in W [N]:
///
///   f = K (p_leader - p_follower) + B (v_leader - v_follower)
///
/// The reaction on the leader is -f. Pure; real-time safe.
/// Source: Li & Constantinescu 2009, eqs (9), (10), (13), (14).
[[nodiscard]] inline Vec3 computeCouplerForce(const CouplerGains& gains, const PointState& leader,
                                              const PointState& follower) noexcept {
  return gains.stiffness * (leader.p_W - follower.p_W) +
         gains.damping * (leader.v_W - follower.v_W);
}

/// Force with which a unilateral coupler pushes two overlapping bodies apart [N]:
///
///   f = [K overlap + B overlap_rate]+   while overlap > 0, else 0
///
/// `overlap` [m] is their depth in each other, `overlap_rate` [m/s] its rate. A contact cannot
/// pull. Pure; real-time safe. Source: Li & Constantinescu 2009, eqs (7), (8), (11), (12).
[[nodiscard]] inline double computeContactForce(const CouplerGains& gains, double overlap,
                                                double overlap_rate) noexcept {
  if (!(overlap > 0.0)) return 0.0;
  const double force = gains.stiffness * overlap + gains.damping * overlap_rate;
  return force > 0.0 ? force : 0.0;
}

}  // namespace tandem
#pragma GCC visibility pop
