#pragma once

#include "island/rigid_row.h"
#include "island/six.h"

namespace tandem {

/// -dP/du of a contact law: how an impulse along n, s and t falls with velocity.
struct ContactStiffness {
  double nn = 0.0, sn = 0.0, tn = 0.0;  ///< of normal velocity; friction follows the normal impulse
  double ss = 0.0, st = 0.0, tt = 0.0;  ///< of tangential velocity; symmetric

  bool operator==(const ContactStiffness&) const noexcept = default;
};

/// Sum of three directions, each with a factor.
[[nodiscard]] inline Six combine(double n, double s, double t, const Six (&along)[3]) noexcept {
  Six sum = along[0].scaled(n);
  sum.addScaled(s, along[1]);
  sum.addScaled(t, along[2]);
  return sum;
}

/// Velocities along the three directions of a contact point, by velocities of two bodies in units
/// in which each has mass and inertia 1.
struct ContactJacobian {
  int a = -1, b = -1;    ///< block rows; b = -1: a fixed surface
  Six of_a[3], of_b[3];  ///< along n, s and t

  /// Velocity per impulse along direction i.
  [[nodiscard]] double mobility(int i) const noexcept {
    const double mobility_a = dot(of_a[i], of_a[i]);
    return b < 0 ? mobility_a : mobility_a + dot(of_b[i], of_b[i]);
  }
};

/// Signorini's law for the normal of a point and Coulomb's for its tangents, in the form of Alart
/// and Curnier (1991), with multipliers P0 and slip u above the wanted one:
///
///   q = P0 - rho u,   open (q_n <= 0): P = 0,   stick (|q_t| <= mu q_n): P = q,
///   slide: P = (q_n, mu q_n d), d = q_t / |q_t|
struct PointLaw {
  using Local = RigidRow::Local;
  using Mode = RigidRow::Mode;

  Local u;            ///< [m/s]
  Local held, P0, P;  ///< [N s]
  double rho_n = 0.0, rho_t = 0.0, friction = 0.0;
  Mode mode = Mode::kUnknown;
  Local slip_before;  ///< direction of sliding in the last iteration
  ContactStiffness D;

  [[nodiscard]] Local push() const noexcept {
    return {P0.n - rho_n * u.n, P0.s - rho_t * u.s, P0.t - rho_t * u.t};
  }
  /// Sets the penalties: `stiffness` times what J's directions have as mass.
  void setStiffness(const ContactJacobian& J, double stiffness) noexcept;
  /// Mode that the present velocity asks for.
  [[nodiscard]] Mode findMode() const noexcept { return findMode(push()); }
  /// Takes the mode that the present velocity asks for, and with it P and D. Friction that turns
  /// round within an iteration stops the slip instead; then `is_forced` becomes true.
  void choose(bool& has_changed, bool& is_forced) noexcept;
  /// P and D by the law of the mode.
  void respond() noexcept { respond(push()); }
  /// P and D of sliding, linear about the velocity `slide` [m/s], at which P0 is the answer.
  void respondNear(const Local& slide) noexcept;

 private:
  [[nodiscard]] Mode findMode(const Local& q) const noexcept;
  void respond(const Local& q) noexcept;
};

/// Friction against spinning (n) and rolling (s, t) at a point: the same law for angular
/// velocities, with limits by the normal impulse of the point.
struct TwistLaw {
  using Local = RigidRow::Local;

  Local w;            ///< [rad/s]
  Local held, T0, T;  ///< [N m s]
  double rho_n = 0.0, rho_t = 0.0;
  ContactStiffness D;

  void setStiffness(const ContactJacobian& J, double stiffness) noexcept;
  void respond(double spin_limit, double roll_limit) noexcept;
};

}  // namespace tandem
