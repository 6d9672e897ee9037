#include "island/contact_law.h"

#include <algorithm>
#include <cmath>

namespace tandem {
namespace {

/// Friction of size `limit` along q, and its change with slip.
struct Slide {
  double s = 0.0, t = 0.0;  ///< direction
  ContactStiffness D;

  Slide(double q_s, double q_t, double limit, double rho) noexcept {
    const double size = std::sqrt(q_s * q_s + q_t * q_t);
    if (!(size > 0.0)) return;
    s = q_s / size;
    t = q_t / size;
    const double k = std::min(1.0, limit / size) * rho;
    D.ss = k * (1.0 - s * s);
    D.st = -k * s * t;
    D.tt = k * (1.0 - t * t);
  }
};

/// Sets a law's penalties: `stiffness` times what J's directions have as mass.
template <typename Law>
void setPenalties(Law& law, const ContactJacobian& J, double stiffness) noexcept {
  const auto divide = [&](double mobility) { return mobility > 0.0 ? stiffness / mobility : 0.0; };
  law.rho_n = divide(J.mobility(0));
  law.rho_t = divide(std::max(J.mobility(1), J.mobility(2)));
}

}  // namespace

void PointLaw::setStiffness(const ContactJacobian& J, double stiffness) noexcept {
  setPenalties(*this, J, stiffness);
}

void TwistLaw::setStiffness(const ContactJacobian& J, double stiffness) noexcept {
  setPenalties(*this, J, stiffness);
}

PointLaw::Mode PointLaw::findMode(const Local& q) const noexcept {
  if (!(q.n > 0.0)) return Mode::kOpen;
  const double limit = friction * q.n;
  return friction > 0.0 && q.s * q.s + q.t * q.t <= limit * limit ? Mode::kStick : Mode::kSlide;
}

void PointLaw::choose(bool& has_changed, bool& is_forced) noexcept {
  const Local q = push();
  Mode next = findMode(q);
  if (next == Mode::kSlide && friction > 0.0) {
    const double size = std::sqrt(q.s * q.s + q.t * q.t);
    const Local slip{0.0, q.s / size, q.t / size};
    if (mode == Mode::kSlide && slip.s * slip_before.s + slip.t * slip_before.t < -0.5) {
      next = Mode::kStick;
      is_forced = true;
    }
    slip_before = next == Mode::kSlide ? slip : Local{};
  }
  has_changed |= next != mode;
  mode = next;
  respond(q);
}

void PointLaw::respond(const Local& q) noexcept {
  D = {};
  switch (mode) {
    case Mode::kStick:
      P = q;
      D.nn = rho_n;
      D.ss = D.tt = rho_t;
      return;
    case Mode::kSlide: {
      const double limit = friction * std::max(0.0, q.n);
      const Slide slide(q.s, q.t, limit, rho_t);
      P = {q.n, friction * q.n * slide.s, friction * q.n * slide.t};
      D = slide.D;
      D.nn = rho_n;
      D.sn = friction * rho_n * slide.s;
      D.tn = friction * rho_n * slide.t;
      return;
    }
    default:
      P = {};
  }
}

void PointLaw::respondNear(const Local& slide) noexcept {
  const double limit = friction * P0.n;
  const Slide along(P0.s - rho_t * slide.s, P0.t - rho_t * slide.t, limit, rho_t);
  D = along.D;
  D.nn = rho_n;
  D.sn = friction * rho_n * along.s;
  D.tn = friction * rho_n * along.t;
  const double s = u.s - slide.s, t = u.t - slide.t;
  P = {P0.n - rho_n * u.n, limit * along.s - D.sn * u.n - D.ss * s - D.st * t,
       limit * along.t - D.tn * u.n - D.st * s - D.tt * t};
}

void TwistLaw::respond(double spin_limit, double roll_limit) noexcept {
  T = {T0.n - rho_n * w.n, T0.s - rho_t * w.s, T0.t - rho_t * w.t};
  D = {};
  if (std::abs(T.n) < spin_limit) {
    D.nn = rho_n;
  } else {
    T.n = std::copysign(spin_limit, T.n);
  }
  if (!(roll_limit > 0.0)) {
    T.s = T.t = 0.0;
    return;
  }
  if (T.s * T.s + T.t * T.t <= roll_limit * roll_limit) {
    D.ss = D.tt = rho_t;
    return;
  }
  const Slide slide(T.s, T.t, roll_limit, rho_t);
  const double nn = D.nn;
  D = slide.D;
  D.nn = nn;
  T.s = roll_limit * slide.s;
  T.t = roll_limit * slide.t;
}

}  // namespace tandem
