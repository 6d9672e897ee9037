#include "bench/account/between_looks.h"

namespace tandem::demos::bench {

Vec3 computeTurn(const Quat& from, const Quat& to) {
  const Eigen::AngleAxisd turn(to * from.conjugate());
  const double angle = turn.angle() > M_PI ? turn.angle() - 2.0 * M_PI : turn.angle();
  return angle * turn.axis();
}

BetweenLooks::BetweenLooks(const RigidState& from, const RigidState& to, double dt)
    : from_(from), to_(to), turn_W_(computeTurn(from.q_WB, to.q_WB)), dt_(dt) {}

RigidState BetweenLooks::at(double s) const {
  const double t = 1.0 - s;
  // Weights of the way to the end and of the velocities at both ends, then the rates of the
  // weights.
  const double way = s * s * (1.0 + 2.0 * t), out = dt_ * s * t * t, in = -dt_ * s * s * t;
  const double way_rate = 6.0 * s * t / dt_, out_rate = t * (1.0 - 3.0 * s),
               in_rate = s * (1.0 - 3.0 * t);
  const Vec3 p_W = to_.p_W - from_.p_W;
  RigidState state;
  state.p_W = from_.p_W + way * p_W + out * from_.v_W + in * to_.v_W;
  state.v_W = way_rate * p_W + out_rate * from_.v_W + in_rate * to_.v_W;
  const Vec3 turn_W = way * turn_W_ + out * from_.w_W + in * to_.w_W;
  const double angle = turn_W.norm();
  state.q_WB =
      angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn_W / angle)) * from_.q_WB : from_.q_WB;
  state.w_W = way_rate * turn_W_ + out_rate * from_.w_W + in_rate * to_.w_W;
  return state;
}

}  // namespace tandem::demos::bench
