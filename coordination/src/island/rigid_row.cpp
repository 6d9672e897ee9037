#include "island/rigid_row.h"

#include "island/locked_axis.h"

namespace tandem {
namespace {

/// Makes two unit vectors orthogonal to n and to each other.
void makeTangents(const PlainVec& n, PlainVec& s, PlainVec& t) noexcept {
  // The world axis most orthogonal to n gives the first.
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const PlainVec axis = x <= y && x <= z ? PlainVec(1, 0, 0)
                        : y <= z         ? PlainVec(0, 1, 0)
                                         : PlainVec(0, 0, 1);
  s = cross(n, axis);
  s = s / std::sqrt(dot(s, s));
  t = cross(n, s);
}

/// Share of its determinant below which friction acts along one tangent only.
constexpr double kOneTangent = 1e-12, kOneTangentWithFactors = 1e-4;

}  // namespace

RigidMover::RigidMover(const ModelBody& body, const RigidState& state) noexcept
    : v(state.v_W),
      w(state.w_W),
      inverse_mass(body.inverse_mass),
      radius_squared(body.bounding_radius * body.bounding_radius),
      roots(body, PlainRotation(state.q_WB)),
      ready(true) {
  const MassFactors& factors = body.factors;
  is_free = factors.way_is_even;
  inverse_mass_W = is_free ? PlainVec(inverse_mass, inverse_mass, inverse_mass)
                           : inverse_mass * PlainVec(factors.way_W);
  inertia_x = roots.x.x * roots.x + roots.y.x * roots.y + roots.z.x * roots.z;
  inertia_y = roots.x.y * roots.x + roots.y.y * roots.y + roots.z.y * roots.z;
  inertia_z = roots.x.z * roots.x + roots.y.z * roots.y + roots.z.z * roots.z;
}

void RigidRow::setUp(RigidMover& mover_a, RigidMover& mover_b, const PlainVec& arm_a,
                     const PlainVec& arm_b, const PlainVec& n_W,
                     const PlainVec& surface_W) noexcept {
  a = &mover_a;
  b = &mover_b;
  b_moves_ = mover_b.ready;
  axis_[0].direction = n_W;
  makeTangents(n_W, axis_[1].direction, axis_[2].direction);
  for (Axis& axis : axis_) {
    axis.arm_a = cross(arm_a, axis.direction);
    if (b_moves_) axis.arm_b = cross(arm_b, axis.direction);
    axis.surface = dot(axis.direction, surface_W);
  }
  findTurns(axis_[0]);
  const double normal = mobility(0, 0);
  const bool are_free = a->is_free && (!b_moves_ || b->is_free);
  const double free_normal = a->inverse_mass + (b_moves_ ? b->inverse_mass : 0.0);
  const bool is_locked = !are_free && isLocked(normal, free_normal);
  inverse_normal = normal > 0.0 && !is_locked ? 1.0 / normal : 0.0;
}

void RigidRow::findTurns(Axis& axis) const noexcept {
  axis.turn_a = a->turnBy(axis.arm_a);
  if (b_moves_) axis.turn_b = b->turnBy(axis.arm_b);
}

void RigidRow::prepareSweeps() noexcept {
  findTurns(axis_[1]);
  findTurns(axis_[2]);
  normal_to_s_ = mobility(1, 0);
  normal_to_t_ = mobility(2, 0);
  const double ss = mobility(1, 1), st = mobility(1, 2), tt = mobility(2, 2);
  const double determinant = ss * tt - st * st;
  const double sum = ss + tt;
  slide_ = sum > 0.0 ? 1.0 / sum : 0.0;
  const bool are_free = a->is_free && (!b_moves_ || b->is_free);
  if (determinant > (are_free ? kOneTangent : kOneTangentWithFactors) * (ss * ss + tt * tt)) {
    stick_ss_ = tt / determinant;
    stick_st_ = -st / determinant;
    stick_tt_ = ss / determinant;
  } else {
    // Factors lock one tangent, or a mixture: the other has all the mobility.
    stick_ss_ = slide_ * slide_ * ss;
    stick_st_ = slide_ * slide_ * st;
    stick_tt_ = slide_ * slide_ * tt;
  }
}

/// As a turn about n and one about a tangent, each as if it acted alone.
[[gnu::noinline]] void RigidRow::resistTurning() noexcept {
  const PlainVec &n = axis_[0].direction, &s = axis_[1].direction, &t = axis_[2].direction;
  const auto mobility = [&](const PlainVec& axis) {
    return dot(axis, a->turnBy(axis)) + (b_moves_ ? dot(axis, b->turnBy(axis)) : 0.0);
  };
  const auto divide = [](double value, double by) { return by > 0.0 ? value / by : 0.0; };
  const PlainVec w = b_moves_ ? a->w - b->w : a->w;
  const double freest = std::max(mobility(s), mobility(t));
  const double spin_limit = spinning * impulse.n, roll_limit = rolling * impulse.n;
  Local wanted_twist{twist.n - divide(dot(n, w), mobility(n)), twist.s - divide(dot(s, w), freest),
                     twist.t - divide(dot(t, w), freest)};
  wanted_twist.n = std::clamp(wanted_twist.n, -spin_limit, spin_limit);
  const double size = std::hypot(wanted_twist.s, wanted_twist.t);
  if (size > roll_limit) {
    wanted_twist.s *= roll_limit / size;
    wanted_twist.t *= roll_limit / size;
  }
  applyTwist({wanted_twist.n - twist.n, wanted_twist.s - twist.s, wanted_twist.t - twist.t});
  twist = wanted_twist;
}

}  // namespace tandem
