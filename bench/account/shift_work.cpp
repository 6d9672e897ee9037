// Energy that an EnergyAccount gets from moving rigid bodies out of overlap.

#include "bench/account/between_looks.h"
#include "bench/account/energy_account.h"

namespace tandem::demos::bench {
namespace {

/// Part of a way [m] that velocities `first` and `last` at its ends do not explain. The velocity
/// changed evenly. Or it changed at the one moment that best explains the way along the change.
Vec3 computeRest(const Vec3& way, const Vec3& first, const Vec3& last, double dt) {
  const Vec3 rest = way - dt * first, change = dt * (last - first);
  const double square = change.squaredNorm();
  const double fitting = square > 0.0 ? rest.dot(change) / square : 0.5;
  return rest - (fitting >= 0.0 && fitting <= 1.0 ? fitting : 0.5) * change;
}

}  // namespace

/// The energy that couplers, contacts and weight gain by the shifts.
double EnergyAccount::workOfShifts(double dt) {
  for (Shift& shift : shifts_) shift = {};
  const bool touches = island_.counters().rigid_points > rigid_points_;
  rigid_points_ = island_.counters().rigid_points;
  if (!touches) return 0.0;
  return computePotential(now_.states) - computePotential(findUnshifted(dt));
}

/// Fills `shifts_`; returns the states without them.
std::vector<RigidState> EnergyAccount::findUnshifted(double dt) {
  std::vector<RigidState> unshifted = now_.states;
  for (std::size_t b = 0; b < shifts_.size(); ++b) {
    const auto index = static_cast<BodyIndex>(b);
    if (!island_.isDynamic(index) || !island_.body(index).is_rigid || !last_.active[b]) continue;
    const RigidState &from = last_.states[b], &to = now_.states[b];
    Shift& shift = shifts_[b];
    shift.way_W = computeRest(to.p_W - from.p_W, from.v_W, to.v_W, dt);
    shift.turn_W = computeRest(computeTurn(from.q_WB, to.q_WB), from.w_W, to.w_W, dt);
    unshifted[b].p_W -= shift.way_W;
    const double angle = shift.turn_W.norm();
    if (angle > 0.0)
      unshifted[b].q_WB = Quat(Eigen::AngleAxisd(-angle, shift.turn_W / angle)) * to.q_WB;
  }
  return unshifted;
}

/// Potential energy of springs and weight [J].
double EnergyAccount::computePotential(const std::vector<RigidState>& states) const {
  double potential = 0.0;
  for (BodyIndex b = 0; b < island_.bodyCount(); ++b)
    if (island_.isDynamic(b) && island_.body(b).is_rigid)
      potential -= island_.body(b).mass *
                   scene_.gravity_W.dot(states[static_cast<std::size_t>(b)].p_W - scene_.origin_W);
  for (CouplerIndex c = 0; c < island_.couplerCount(); ++c) {
    const BodyIndex b = island_.follower(c);
    if (!island_.isDynamic(b)) continue;
    const RigidState &state = states[static_cast<std::size_t>(b)], &target = island_.target(c);
    const CouplerSettings& gains = island_.presentGains(c);
    potential += 0.5 * gains.linear.stiffness * (target.p_W - state.p_W).squaredNorm() +
                 0.5 * gains.angular.stiffness * computeTurn(state.q_WB, target.q_WB).squaredNorm();
  }
  for (Pair pair : now_.pairs) {
    if (!movesAny(pair) || pair.obstacle) continue;
    measure(states[static_cast<std::size_t>(pair.sphere)],
            states[static_cast<std::size_t>(pair.other)], pair);
    const double overlap = std::max(0.0, pair.overlap);
    potential += 0.5 * scene_.contact.stiffness * overlap * overlap;
  }
  return potential;
}

}  // namespace tandem::demos::bench
