#include "island_model.h"

#include <cmath>

namespace tandem {
namespace {

/// Rotation vector of the turn from `from` to `to`, in W [rad]; the short way round.
Vec3 computeTurn(const Quat& from, const Quat& to) noexcept {
  Quat turn = to * from.conjugate();
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  if (sine < 1e-12) return 2.0 * turn.vec();
  return 2.0 * std::atan2(sine, turn.w()) / sine * turn.vec();
}

}  // namespace

Wrench computeCouplerWrench(const ModelCoupler& coupler, const RigidState& follower) noexcept {
  Wrench wrench;
  wrench.f_W =
      computeCouplerForce(coupler.settings.linear, coupler.target.point(), follower.point());
  const CouplerGains& angular = coupler.settings.angular;
  if (angular.stiffness != 0.0 || angular.damping != 0.0)
    wrench.t_W = angular.stiffness * computeTurn(follower.q_WB, coupler.target.q_WB) +
                 angular.damping * (coupler.target.w_W - follower.w_W);
  return wrench;
}

RigidState extrapolate(const ModelBody& body, double dt) noexcept {
  RigidState state = body.state;
  if (body.settings.motion == Motion::kPrescribed) state.p_W += dt * state.v_W;
  return state;
}

}  // namespace tandem
