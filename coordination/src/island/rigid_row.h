#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/plain_vec.h"
#include "island/island_model.h"
#include "island/mass_roots.h"

namespace tandem {

/// Velocity and inertia of a body while its contacts are solved. A fixed surface has inverse mass
/// 0.
struct RigidMover {
  PlainVec v, w;            ///< [m/s], [rad/s], in W
  PlainVec shift, turn;     ///< change of pose by this step's impulses [m], [rad]
  PlainVec v_last, w_last;  ///< velocities at the last measurement
  PlainVec v_held, w_held;  ///< velocities before sweeps
  double inverse_mass = 0.0, radius_squared = 0.0;
  PlainVec inverse_mass_W;                   ///< along the axes of W: with linear factors
  bool is_free = true;                       ///< no linear factors
  PlainVec inertia_x, inertia_y, inertia_z;  ///< rows of the inverse inertia in W
  MassRoots roots;
  PlainVec way;        ///< of the centre since the start of the step [m]
  PlainRotation back;  ///< turns directions back to the start of the step
  bool ready = false;  ///< set up for this step
  /// For ContactSolver: its block row, and its number of points with other bodies.
  int place = -1, degree = 0;

  RigidMover() = default;
  RigidMover(const ModelBody& body, const RigidState& state) noexcept;

  [[nodiscard]] PlainVec turnBy(const PlainVec& angular_impulse) const noexcept {
    return {dot(inertia_x, angular_impulse), dot(inertia_y, angular_impulse),
            dot(inertia_z, angular_impulse)};
  }
  /// Way since the start of the step of the point that is now at `arm` [m].
  [[nodiscard]] PlainVec wayOf(const PlainVec& arm) const noexcept {
    return way + arm - back.toWorld(arm);
  }
  [[nodiscard]] PlainVec velocityAt(const PlainVec& arm) const noexcept {
    return v + cross(w, arm);
  }
  /// Square of the greater speed that velocities give it: of its centre, and of its surface around
  /// that [m^2/s^2].
  [[nodiscard]] double squareOf(const PlainVec& linear, const PlainVec& angular) const noexcept {
    return std::max(dot(linear, linear), radius_squared * dot(angular, angular));
  }
};

/// Normal and two tangents of a contact point, with the effect of an impulse along each on both
/// bodies. All impulses and velocities are along these three directions.
class RigidRow {
 public:
  /// `n_W` points from b to a; arms start at the centres of mass. `surface_W` is the velocity of a
  /// fixed surface itself. b is fixed if it is not ready.
  void setUp(RigidMover& a, RigidMover& b, const PlainVec& arm_a, const PlainVec& arm_b,
             const PlainVec& n_W, const PlainVec& surface_W) noexcept;

  /// False if no impulse can move the point.
  [[nodiscard]] bool canMove() const noexcept { return inverse_normal > 0.0; }

  struct Local {
    double n = 0.0, s = 0.0, t = 0.0;

    [[nodiscard]] Local operator-(const Local& other) const noexcept {
      return {n - other.n, s - other.s, t - other.t};
    }
  };
  enum class Mode : std::uint8_t { kUnknown, kOpen, kStick, kSlide };

  [[nodiscard]] const PlainVec& direction(int i) const noexcept { return axis_[i].direction; }
  /// Arm x direction.
  [[nodiscard]] const PlainVec& armOfA(int i) const noexcept { return axis_[i].arm_a; }
  [[nodiscard]] const PlainVec& armOfB(int i) const noexcept { return axis_[i].arm_b; }
  [[nodiscard]] double normalVelocity() const noexcept { return velocityAlong(0); }
  [[nodiscard]] Local toLocal(const PlainVec& vector_W) const noexcept {
    return {dot(axis_[0].direction, vector_W), dot(axis_[1].direction, vector_W),
            dot(axis_[2].direction, vector_W)};
  }
  [[nodiscard]] PlainVec toWorld(const Local& local) const noexcept {
    return local.n * axis_[0].direction + local.s * axis_[1].direction +
           local.t * axis_[2].direction;
  }

  [[nodiscard]] double velocityAlong(int i) const noexcept {
    const Axis& axis = axis_[i];
    const double of_a = dot(axis.direction, a->v) + dot(axis.arm_a, a->w) - axis.surface;
    if (!b_moves_) return of_a;
    return of_a - dot(axis.direction, b->v) - dot(axis.arm_b, b->w);
  }

  /// Before the first solve().
  void prepareSweeps() noexcept;
  /// One relaxation: sets the normal velocity to `wanted`, then removes slip within Coulomb's cone.
  void solve() noexcept {
    const double normal_before = impulse.n;
    impulse.n = std::max(0.0, normal_before + (wanted - velocityAlong(0)) * inverse_normal);
    Local change{impulse.n - normal_before, 0.0, 0.0};
    const double limit = friction * impulse.n;
    if (limit > 0.0 || impulse.s != 0.0 || impulse.t != 0.0) {
      const double us = velocityAlong(1) + normal_to_s_ * change.n;
      const double ut = velocityAlong(2) + normal_to_t_ * change.n;
      double s = impulse.s - (stick_ss_ * us + stick_st_ * ut);
      double t = impulse.t - (stick_st_ * us + stick_tt_ * ut);
      if (s * s + t * t > limit * limit) {
        // Sliding: friction acts along the slip, whatever the mobility in other directions.
        s = impulse.s - slide_ * us;
        t = impulse.t - slide_ * ut;
        const double size_squared = s * s + t * t;
        if (size_squared > limit * limit) {
          const double scale = limit / std::sqrt(size_squared);
          s *= scale;
          t *= scale;
        }
      }
      change.s = s - impulse.s;
      change.t = t - impulse.t;
      impulse.s = s;
      impulse.t = t;
    }
    applySwept(change);
    if (resistsTurning()) [[unlikely]]
      resistTurning();
  }

  /// Applies an impulse to both bodies.
  void apply(const Local& change) noexcept {
    const PlainVec linear = toWorld(change);
    a->v = a->v + multiplyEach(a->inverse_mass_W, linear);
    a->w = a->w + a->turnBy(momentOnA(change));
    if (!b_moves_) return;
    b->v = b->v - multiplyEach(b->inverse_mass_W, linear);
    b->w = b->w - b->turnBy(momentOnB(change));
  }

  /// Shifts the poses of both bodies by an impulse times a time [N s^2].
  void shift(const Local& by) noexcept {
    const PlainVec linear = toWorld(by);
    a->shift = a->shift + multiplyEach(a->inverse_mass_W, linear);
    a->turn = a->turn + a->turnBy(momentOnA(by));
    if (!b_moves_) return;
    b->shift = b->shift - multiplyEach(b->inverse_mass_W, linear);
    b->turn = b->turn - b->turnBy(momentOnB(by));
  }

  /// True if friction acts against turning. What it held is let go even where it no longer may.
  [[nodiscard]] bool resistsTurning() const noexcept {
    return rolling > 0.0 || spinning > 0.0 || twist.n != 0.0 || twist.s != 0.0 || twist.t != 0.0;
  }
  /// Applies an angular impulse to both bodies.
  void applyTwist(const Local& change) noexcept {
    const PlainVec angular = toWorld(change);
    a->w = a->w + a->turnBy(angular);
    if (b_moves_) b->w = b->w - b->turnBy(angular);
  }

  /// Way of a beside b that the shifts have made along direction i [m].
  [[nodiscard]] double shiftAlong(int i) const noexcept {
    const Axis& axis = axis_[i];
    return dot(axis.direction, a->shift - b->shift) + dot(axis.arm_a, a->turn) -
           dot(axis.arm_b, b->turn);
  }
  /// Distance by which the shifts have opened the contact [m].
  [[nodiscard]] double normalShift() const noexcept { return shiftAlong(0); }

  RigidMover *a = nullptr, *b = nullptr;
  Local held;                            ///< impulse that the velocities have already [N s]
  Local impulse;                         ///< total of this step [N s]
  Local twist_held, twist;               ///< the same against turning [N m s]
  Mode mode = Mode::kUnknown;            ///< that of the last step, then of this one
  Local slide;                           ///< that sliding was last seen to have [m/s]
  bool is_swept = false;                 ///< modes have not settled: sweeps took over
  Local slip;                            ///< tangential way of a beside b in this step [m]
  bool is_anchored = false;              ///< it stuck in the last step, and `slip` is known
  double distance = 0.0;                 ///< above the overlap that the pair may keep [m]
  double wanted = 0.0;                   ///< least normal velocity [m/s]
  double friction = 0.0;                 ///< Coulomb's coefficient
  double rolling = 0.0, spinning = 0.0;  ///< RigidContact
  double inverse_normal = 0.0;           ///< impulse per normal velocity [kg]

 private:
  struct Axis {
    PlainVec direction;
    PlainVec arm_a, arm_b;    ///< arm x direction
    PlainVec turn_a, turn_b;  ///< angular velocity per impulse; for sweeps, but for the normal
    double surface = 0.0;     ///< velocity of a fixed surface [m/s]
  };

  [[nodiscard]] PlainVec momentOnA(const Local& push) const noexcept {
    return push.n * axis_[0].arm_a + push.s * axis_[1].arm_a + push.t * axis_[2].arm_a;
  }
  [[nodiscard]] PlainVec momentOnB(const Local& push) const noexcept {
    return push.n * axis_[0].arm_b + push.s * axis_[1].arm_b + push.t * axis_[2].arm_b;
  }
  /// As apply(), after prepareSweeps().
  void applySwept(const Local& change) noexcept {
    const PlainVec linear = toWorld(change);
    a->v = a->v + multiplyEach(a->inverse_mass_W, linear);
    a->w =
        a->w + change.n * axis_[0].turn_a + change.s * axis_[1].turn_a + change.t * axis_[2].turn_a;
    if (!b_moves_) return;
    b->v = b->v - multiplyEach(b->inverse_mass_W, linear);
    b->w = b->w -
           (change.n * axis_[0].turn_b + change.s * axis_[1].turn_b + change.t * axis_[2].turn_b);
  }

  /// Removes rolling and spinning, within what the normal impulse allows.
  void resistTurning() noexcept;

  void findTurns(Axis& axis) const noexcept;
  /// Velocity along i per impulse along j.
  [[nodiscard]] double mobility(int i, int j) const noexcept {
    const double of_a = wayOf(*a, i, j) + dot(axis_[i].arm_a, axis_[j].turn_a);
    if (!b_moves_) return of_a;
    return of_a + wayOf(*b, i, j) + dot(axis_[i].arm_b, axis_[j].turn_b);
  }
  [[nodiscard]] double wayOf(const RigidMover& mover, int i, int j) const noexcept {
    if (mover.is_free) return i == j ? mover.inverse_mass : 0.0;
    return dot(axis_[i].direction, multiplyEach(mover.inverse_mass_W, axis_[j].direction));
  }

  Axis axis_[3];
  double normal_to_s_ = 0.0, normal_to_t_ = 0.0;
  double stick_ss_ = 0.0, stick_st_ = 0.0, stick_tt_ = 0.0;
  double slide_ = 0.0;
  bool b_moves_ = false;  ///< b is not a fixed surface
};

}  // namespace tandem
