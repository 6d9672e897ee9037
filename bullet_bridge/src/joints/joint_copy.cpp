#include "joints/joint_copy.h"

#include <algorithm>
#include <cmath>

#include "joints/joint_measure.h"

namespace tandem {
namespace {

using Goes = JointCoordinate::Goes;

constexpr double kTurn = 2.0 * M_PI;

constexpr double kMostForce = 1e12;  // of a motor without bound [N or N m]

/// A drive that damps faster than this holds its speed [1/s].
constexpr double kFastestDrive = 2e3;

int numberOf(JointRowKind kind, int axis) {
  return static_cast<int>(JointCopy::numberOf(kind, static_cast<std::size_t>(axis)));
}

/// The angle, turns more or less, that is nearest to 0.
double takeTurnsOff(double angle) {
  return std::abs(angle) <= M_PI ? angle : std::remainder(angle, kTurn);
}

/// The angle, a turn more or less, that is nearest to its range.
double moveToRange(double angle, double low, double high) {
  const double to_low = std::abs(std::remainder(low - angle, kTurn));
  const double to_high = std::abs(std::remainder(high - angle, kTurn));
  if (angle < low) return to_low < to_high ? angle : angle + kTurn;
  if (angle > high) return to_low < to_high ? angle - kTurn : angle;
  return angle;
}

/// Finds the rate of a row's speed while the bodies keep their velocities. A linear row's is
///
///   u  = n (v_a - v_b) + (r_a x n) w_a - (r_b x n) w_b
///   u' = n' (v_a - v_b) + (r_a' x n + r_a x n') w_a - (r_b' x n + r_b x n') w_b
///
/// and an angular one's u' = turn' (w_a - w_b). Both are direction . vector, with the same vector
/// for all directions that go with the same.
class Bends {
 public:
  Bends(const RigidState& a, const RigidState& b, const PlainVec& r_a,
        const PlainVec& r_b) noexcept {
    const PlainVec w_a(a.w_W), w_b(b.w_W), v(Vec3(a.v_W - b.v_W));
    const PlainVec rate_b = cross(w_b, r_b), rate_a = rate_b - v;
    with_world_ = cross(w_a, rate_a) - cross(w_b, rate_b);
    with_a_ = with_world_ + cross(v + cross(w_a, r_a) - rate_b, w_a);
    turn_with_a_ = cross(w_a, w_b);
  }

  /// For a coordinate that does not go alone.
  [[nodiscard]] const PlainVec& of(const JointCoordinate& coordinate) const noexcept {
    if (coordinate.is_angular) return turn_with_a_;
    return coordinate.goes == Goes::kWithA ? with_a_ : with_world_;
  }

 private:
  PlainVec with_world_, with_a_, turn_with_a_;
};

/// Writes the rows of a joint at given poses.
class RowWriter {
 public:
  RowWriter(const JointSettings& joint, const RigidState& a, const RigidState& b,
            std::vector<JointRow>& rows)
      : joint_(joint),
        a_(a),
        b_(b),
        placed_(joint, a, b),
        r_a_(Vec3(placed_.p_b - a.p_W)),
        r_b_(Vec3(placed_.p_b - b.p_W)),
        bends_(a, b, r_a_, r_b_),
        rows_(rows) {}

  void writeAll() {
    if (joint_.kind == JointKind::kGear) return writeGear();
    const JointCoordinates coordinates = measureJoint(joint_, placed_);
    for (std::size_t i = 0; i < 6; ++i)
      if (coordinates[i].is_there && joint_.axes[i].acts())
        writeAxis(static_cast<int>(i), coordinates[i], joint_.axes[i]);
  }

 private:
  /// Bullet's gear holds speeds only, and its angles drift.
  void writeGear() {
    JointRow row;
    row.number = 3;
    row.turn_a_W = a_.q_WB * joint_.a.p;
    row.turn_b_W = joint_.gear_ratio * (b_.q_WB * joint_.b.p);
    row.tells_bend = true;  // An axis that turns about itself stays.
    rows_.push_back(row);
  }

  void writeAxis(int i, const JointCoordinate& coordinate, const JointAxis& axis) {
    JointRow row;
    fill(coordinate, axis, row);
    double q = axis.sense * coordinate.way;
    if (axis.counts_turns && i >= 3) q = axis.near + std::remainder(q - axis.near, kTurn);
    if (axis.isLocked()) {
      writeLock(i, row, coordinate.way - axis.sense * axis.low, axis);
    } else if (!axis.isFree()) {
      if (i >= 3 && axis.high < HUGE_VAL && !axis.counts_turns)
        q = moveToRange(q, axis.low, axis.high);
      writeLimit(numberOf(JointRowKind::kHold, i), axis.sense, row, q - axis.low, axis);
      writeLimit(numberOf(JointRowKind::kHighLimit, i), -axis.sense, row, axis.high - q, axis);
    }
    if (!axis.isDriven()) return;
    // Motors and springs act along axes of unit length.
    if (i >= 3) scaleRow(row, 1.0 / std::max(row.turn_a_W.norm(), 1e-9));
    if (axis.motor != JointMotor::kNone && !axis.isLocked()) writeMotor(i, row, q, axis);
    if (axis.has_spring) writeSpring(i, row, q, axis);
    if (axis.push != 0.0 && !axis.isLocked()) writePush(i, row, axis);
  }

  /// Both ends get a linear row's force at the same point, so no angular momentum is made. That
  /// of b lets n stay in the frame of a. But a bounded pin may be open, and pulls each end at its
  /// own point, as Bullet's does.
  void fill(const JointCoordinate& coordinate, const JointAxis& axis, JointRow& row) const {
    const PlainVec direction(coordinate.direction_W);
    const bool pulls = axis.hold_force < HUGE_VAL && joint_.kind != JointKind::kRail;
    if (coordinate.is_angular) {
      row.turn_a_W = coordinate.direction_W;
      row.turn_b_W = -coordinate.direction_W;
    } else {
      row.n_W = coordinate.direction_W;
      const PlainVec at_a = pulls ? PlainVec(Vec3(placed_.p_a - a_.p_W)) : r_a_;
      row.turn_a_W = cross(at_a, direction).toVec3();
      row.turn_b_W = cross(direction, r_b_).toVec3();
    }
    row.tells_bend = coordinate.goes != Goes::kAlone && !pulls;
    if (row.tells_bend) row.bend = dot(direction, bends_.of(coordinate));
  }

  static void scaleRow(JointRow& row, double factor) {
    row.n_W *= factor;
    row.turn_a_W *= factor;
    row.turn_b_W *= factor;
    row.bend *= factor;
  }

  void writeLock(int i, const JointRow& along, double way, const JointAxis& axis) {
    JointRow& row = rows_.emplace_back(along);
    row.number = numberOf(JointRowKind::kHold, i);
    row.way = i >= 3 ? takeTurnsOff(way) : way;
    if (axis.hold_force < HUGE_VAL) {
      // A bounded pin pulls as Bullet's does: a part of the way per step of the host.
      row.law = JointLaw::kMotor;
      seek(row, 0.0, axis.erp / joint_.host_dt, -row.way);
      row.low = -axis.hold_force;
      row.high = axis.hold_force;
    } else {
      soften(row, axis);
    }
  }

  void writeLimit(int number, int sign, JointRow row, double way, const JointAxis& axis) {
    scaleRow(row, sign);
    const double approach = -computeSpeed(row);
    if (way > std::max(JointCopy::kLimitReach, approach * JointCopy::kLimitTime)) return;
    row.law = JointLaw::kLimit;
    row.number = number;
    row.way = way;
    row.bounce = axis.bounce;
    soften(row, axis);
    rows_.push_back(row);
  }

  void writeMotor(int i, JointRow row, double q, const JointAxis& axis) {
    row.law = JointLaw::kMotor;
    row.number = numberOf(JointRowKind::kDrive, i);
    row.high = std::clamp(axis.force, 0.0, kMostForce);
    row.low = -row.high;
    switch (axis.motor) {
      case JointMotor::kNone:
        return;
      case JointMotor::kSpeed:
        row.speed = axis.speed;
        break;
      case JointMotor::kServo: {
        double error = axis.target - q;
        if (i >= 3) error = std::remainder(error, kTurn);
        const double most = std::abs(axis.speed);
        seek(row, 0.0, axis.gain, axis.sense * error, most);
        break;
      }
      case JointMotor::kSpring: {
        const double force = axis.sense * axis.stiffness * (axis.rest - q);
        seek(row, 0.0, axis.gain * axis.stiffness, axis.sense * (axis.rest - q));
        row.low = -std::abs(force);
        row.high = std::abs(force);
        break;
      }
      case JointMotor::kTurn:
        seek(row, 0.0, axis.gain, -q);
        row.low = 0.0;
        break;
      case JointMotor::kDrive:
        drive(row, q, axis);
        break;
    }
    rows_.push_back(row);
  }

  /// The motor's speed is `start`, and `gain` times the way that is left along the row, at most
  /// `most` [m/s or rad/s].
  void seek(JointRow& row, double start, double gain, double way_left,
            double most = HUGE_VAL) const {
    const double speed = start + gain * way_left;
    row.speed = std::clamp(speed, -most, most);
    if (row.speed == speed) row.speed_rate = -gain * computeSpeed(row);
  }

  /// Bullet mends a share s of the error of the speed in a step of the host, and a part of the way:
  ///
  ///   v' = v + s (speed - v) + gain (target - q)
  ///
  /// Here v has what other forces give in the step. So this is a spring and a damper on the mass
  /// that the joint moves, with 1 / (1 - s) of these gains. With s = 1 it is a speed that is held.
  void drive(JointRow& row, double q, const JointAxis& axis) {
    const double rest = 1.0 - axis.share, by_way = axis.gain * (axis.target - q);
    if (axis.share > kFastestDrive * joint_.host_dt * rest) {
      const double gain = axis.gain / std::min(axis.share, 1.0);
      seek(row, axis.sense * axis.speed, gain, axis.sense * (axis.target - q), axis.most);
      return;
    }
    const double u = axis.sense * computeSpeed(row);
    const double error = axis.share * (axis.speed - u) + by_way;
    const double force = axis.mass * error / (rest * joint_.host_dt);
    row.low = row.high = axis.sense * std::clamp(force, -row.high, row.high);
  }

  void writePush(int i, JointRow row, const JointAxis& axis) {
    row.law = JointLaw::kMotor;
    row.number = numberOf(JointRowKind::kElastic, i);
    row.low = row.high = axis.sense * axis.push;
    rows_.push_back(row);
  }

  void writeSpring(int i, JointRow row, double q, const JointAxis& axis) {
    if (axis.stiffness <= 0.0 && axis.damping <= 0.0) return;
    row.number = numberOf(JointRowKind::kElastic, i);
    row.way = axis.sense * (q - axis.rest);
    row.stiffness = axis.stiffness;
    row.damping = axis.damping;
    rows_.push_back(row);
  }

  [[nodiscard]] double computeSpeed(const JointRow& row) const {
    return row.n_W.dot(a_.v_W - b_.v_W) + row.turn_a_W.dot(a_.w_W) + row.turn_b_W.dot(b_.w_W);
  }

  /// Bullet's softness is an impulse per impulse: with a fixed step, a spring and a damper.
  void soften(JointRow& row, const JointAxis& axis) const {
    if (axis.cfm <= 0.0) return;
    const double inverse =
        row.n_W.squaredNorm() * (joint_.mass_a.inverse_mass + joint_.mass_b.inverse_mass) +
        computeResponse(joint_.mass_a, a_, row.turn_a_W) +
        computeResponse(joint_.mass_b, b_, row.turn_b_W);
    if (inverse <= 0.0) return;
    row.damping = 1.0 / (inverse * axis.cfm * joint_.host_dt);
    row.stiffness = axis.erp * row.damping / joint_.host_dt;
  }

  static double computeResponse(const EndMass& mass, const RigidState& state, const Vec3& turn_W) {
    const Vec3 turn_B = state.q_WB.conjugate() * turn_W;
    return turn_B.cwiseAbs2().dot(mass.inverse_inertia_B);
  }

  const JointSettings& joint_;
  const RigidState& a_;
  const RigidState& b_;
  PlacedJoint placed_;
  PlainVec r_a_, r_b_;  ///< from both bodies to the joint's place on b
  Bends bends_;
  std::vector<JointRow>& rows_;
};

}  // namespace

void JointCopy::evaluate(const RigidState& a, const RigidState& b,
                         std::vector<JointRow>& rows) const noexcept {
  RowWriter(joint_, a, b, rows).writeAll();
}

}  // namespace tandem
