// Rows of private joint copies: they are Bullet's, and they are gradients of what they hold.

#include <cmath>
#include <cstring>
#include <iostream>
#include <random>
#include <set>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "bridge/bullet_rows.h"
#include "bridge/joint_cases.h"

namespace tandem {
namespace {

using test::askBullet;
using test::byWidth;
using test::HostRow;
using test::isUnbounded;
using test::JointCase;
using test::JointRig;
using Rows = std::vector<JointRow>;
using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr std::uint64_t kSeed = 20261126;

class Poses {
 public:
  explicit Poses(std::uint64_t seed) : random_(seed) {}

  Vec3 drawVector(double most) { return Vec3(draw(), draw(), draw()) * most; }
  /// Moves a body by up to `way` [m] and `angle` [rad] in each direction.
  void shake(RigidState& state, double way, double angle) {
    state.p_W += drawVector(way);
    state.q_WB = (rotate(drawVector(angle)) * state.q_WB).normalized();
  }
  static Quat rotate(const Vec3& by) {
    const double angle = by.norm();
    return angle > 0.0 ? test::turn(angle, by) : Quat::Identity();
  }

 private:
  double draw() { return static_cast<double>(random_() >> 11) * 0x1p-52 - 1.0; }

  std::mt19937_64 random_;
};

Rows evaluate(const JointCopy& copy, const RigidState& a, const RigidState& b) {
  Rows rows;
  copy.evaluate(a, b, rows);
  EXPECT_LE(rows.size(), static_cast<std::size_t>(kMostJointRows));
  std::set<int> numbers;
  for (const JointRow& row : rows) {
    EXPECT_TRUE(numbers.insert(row.number).second) << "two rows " << row.number;
    EXPECT_LT(row.number, kMostJointRows);
  }
  return rows;
}

bool isRigidLock(const JointRow& row) {
  return row.law == JointLaw::kLocked && row.stiffness == 0.0 && row.damping == 0.0;
}

RigidState moved(RigidState state, double time) {
  state.p_W += time * state.v_W;
  state.q_WB = Poses::rotate(time * state.w_W) * state.q_WB;
  return state;
}

/// Newton on the locked rows; moves both bodies. Returns the largest way that is left [m or rad].
double closeJoint(const JointCopy& copy, RigidState& a, RigidState& b, int rounds = 12) {
  double left = 0.0;
  for (int round = 0; round < rounds; ++round) {
    Eigen::MatrixXd j(0, 12);
    Eigen::VectorXd way(0);
    for (const JointRow& row : evaluate(copy, a, b)) {
      if (!isRigidLock(row)) continue;
      j.conservativeResize(j.rows() + 1, 12);
      way.conservativeResize(way.size() + 1);
      j.bottomRows(1) << row.n_W.transpose(), row.turn_a_W.transpose(), -row.n_W.transpose(),
          row.turn_b_W.transpose();
      way.tail(1) << -row.way;
    }
    left = way.size() > 0 ? way.cwiseAbs().maxCoeff() : 0.0;
    if (left == 0.0) break;
    const Eigen::VectorXd by = j.completeOrthogonalDecomposition().solve(way);
    a.v_W = by.segment<3>(0), a.w_W = by.segment<3>(3);
    b.v_W = by.segment<3>(6), b.w_W = by.segment<3>(9);
    a = moved(a, 1.0), b = moved(b, 1.0);
    a.v_W = a.w_W = b.v_W = b.w_W = Vec3::Zero();
  }
  return left;
}

/// The part of a row that b feels; that of a follows from the momentum.
Vec6 sideOfB(const Vec3& n, const Vec3& turn_b) {
  Vec6 side;
  side << n, turn_b;
  return side;
}

/// Bullet's two-sided row must be made of ours, and its error of our ways.
void expectLockMade(const HostRow& host, const Rows& rows, double tolerance) {
  Eigen::MatrixXd j(6, 0);
  Eigen::VectorXd way(0);
  for (const JointRow& row : rows) {
    if (!isRigidLock(row)) continue;
    j.conservativeResize(6, j.cols() + 1);
    way.conservativeResize(way.size() + 1);
    // Bullet's Euler rows have unit length, so they are no gradients; ours are longer.
    const double length = row.n_W.isZero() ? row.turn_b_W.norm() : 1.0;
    j.rightCols(1) = sideOfB(row.n_W, row.turn_b_W) / length;
    way.tail(1) << row.way;
  }
  const Vec6 side = sideOfB(host.n, host.turn_b);
  const Eigen::VectorXd parts = j.completeOrthogonalDecomposition().solve(side);
  EXPECT_LT((j * parts - side).norm(), byWidth(1e-3, 2e-3));
  EXPECT_NEAR(host.error, -parts.dot(way), tolerance);
}

/// Bullet's one-sided row must be one of ours, as far past its stop.
void expectLimitFound(const HostRow& host, const Rows& rows, bool is_exact, double tolerance) {
  const double sign = isUnbounded(host.high) ? 1.0 : -1.0;
  const Vec6 side = sign * sideOfB(host.n, host.turn_b).normalized();
  double nearest = HUGE_VAL;
  for (const JointRow& row : rows) {
    if (row.law != JointLaw::kLimit || row.way > 0.0) continue;
    const Vec6 own = sideOfB(row.n_W, row.turn_b_W).normalized();
    if (is_exact && (own - side).norm() > byWidth(1e-3, 1e-2)) continue;
    nearest = std::min(nearest, std::abs(row.way + sign * host.error));
    // Bullet takes the sine of what a cone about one axis is past.
    if (!is_exact) nearest = std::min(nearest, std::abs(std::sin(row.way) + sign * host.error));
  }
  EXPECT_LT(nearest, tolerance) << "limit is " << host.error << " past";
}

// At poses that are slightly off, rows and errors of both agree up to squares of that. But Bullet
// shifts arms of hinges and sliders along the axis, and leaves out what tilts do there: linear
// errors differ by the tilt times that shift.
TEST(JointCopy, HasBulletsRows) {
  constexpr double kOff = byWidth(1e-6, 1e-5);  // [m], [rad]
  std::cout << "seed " << kSeed << '\n';
  Poses poses(kSeed);
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    JointRig rig(of);
    const RigidState start_a = JointRig::stateOf(rig.a), start_b = JointRig::stateOf(rig.b);
    int limits = 0;
    for (int i = 0; i < 100; ++i) {
      RigidState a = start_a, b = start_b;
      poses.shake(b, 0.08, 0.4);
      ASSERT_LT(closeJoint(rig.copy, a, b), 1e-10);
      const bool is_tilted = i % 2 == 0;
      poses.shake(b, kOff, is_tilted ? kOff : 0.0);
      rig.place(a, b);
      const Rows rows = evaluate(rig.copy, a, b);
      for (const HostRow& host : askBullet(*rig.joint, 1.0, 1.0)) {
        const bool is_lock = isUnbounded(host.low) && isUnbounded(host.high);
        // Spring 2 has rows of limits that are not passed, and a spring.
        const double past = isUnbounded(host.high) ? host.error : -host.error;
        if (is_lock) {
          const bool is_shifted = is_tilted && !host.n.isZero();
          expectLockMade(host, rows,
                         is_shifted ? 0.5 * kOff : byWidth(of.is_exact ? 1e-11 : 5e-8, 2e-6));
        } else if (past > 1e-4 && (isUnbounded(host.low) || isUnbounded(host.high))) {
          expectLimitFound(host, rows, of.is_exact, byWidth(1e-9, 5e-6));
          ++limits;
        }
      }
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_EQ(limits > 5, of.has_limits);
  }
}

// Ways are followed through 2 us of motion, from closed poses: central differences are exact to
// squares of that.
TEST(JointCopy, RowsAreGradientsOfTheirWays) {
  constexpr double kTime = 1e-6;  // [s]
  std::cout << "seed " << kSeed << '\n';
  Poses poses(kSeed);
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    if (std::string_view(of.name) == "gear") continue;
    JointRig rig(of);
    int limits = 0;
    for (int i = 0; i < 400; ++i) {
      RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
      const RigidState start = a;
      poses.shake(a, 1.0, 1.0);
      b.q_WB = a.q_WB * start.q_WB.conjugate() * b.q_WB;
      b.p_W = a.p_W + a.q_WB * start.q_WB.conjugate() * (b.p_W - start.p_W);
      poses.shake(b, 0.08, 0.4);
      ASSERT_LT(closeJoint(rig.copy, a, b), 1e-10);
      a.v_W = poses.drawVector(1.0), a.w_W = poses.drawVector(1.0);
      b.v_W = poses.drawVector(1.0), b.w_W = poses.drawVector(1.0);
      const Rows before = evaluate(rig.copy, moved(a, -kTime), moved(b, -kTime));
      const Rows after = evaluate(rig.copy, moved(a, kTime), moved(b, kTime));
      for (const JointRow& row : evaluate(rig.copy, a, b)) {
        if (row.law == JointLaw::kMotor) continue;
        const auto same = [&](const JointRow& other) { return other.number == row.number; };
        const auto first = std::find_if(before.begin(), before.end(), same);
        const auto last = std::find_if(after.begin(), after.end(), same);
        if (first == before.end() || last == after.end()) continue;
        const double u =
            row.n_W.dot(a.v_W - b.v_W) + row.turn_a_W.dot(a.w_W) + row.turn_b_W.dot(b.w_W);
        // Near a singular pose all derivatives are large.
        const double tolerance = 1e-7 + 10.0 * kTime * kTime * std::pow(std::abs(u), 3);
        EXPECT_NEAR((last->way - first->way) / (2.0 * kTime), u, tolerance) << "row " << row.number;
        limits += row.law == JointLaw::kLimit;
      }
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_EQ(limits > 5, of.has_limits);
  }
}

// Speeds of rows at constant velocities, a moment before and after.
TEST(JointCopy, TellsHowRowsBend) {
  constexpr double kTime = 1e-5;  // [s]
  std::cout << "seed " << kSeed << '\n';
  Poses poses(kSeed);
  int known = 0;
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    JointRig rig(of);
    for (int i = 0; i < 50; ++i) {
      RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
      for (RigidState* state : {&a, &b}) {
        poses.shake(*state, 0.3, 1.0);
        state->v_W = poses.drawVector(1.0);
        state->w_W = poses.drawVector(5.0);
      }
      const Rows before = evaluate(rig.copy, moved(a, -kTime), moved(b, -kTime));
      const Rows after = evaluate(rig.copy, moved(a, kTime), moved(b, kTime));
      for (const JointRow& row : evaluate(rig.copy, a, b)) {
        if (!row.tells_bend) continue;
        const auto speedOf = [&](const Rows& rows) {
          for (const JointRow& other : rows)
            if (other.number == row.number)
              return other.n_W.dot(a.v_W - b.v_W) + other.turn_a_W.dot(a.w_W) +
                     other.turn_b_W.dot(b.w_W);
          return std::nan("");
        };
        const double rate = (speedOf(after) - speedOf(before)) / (2.0 * kTime);
        if (std::isnan(rate)) continue;
        EXPECT_NEAR(row.bend, rate, 1e-6) << "row " << row.number;
        known += row.bend != 0.0;
      }
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(known, 1000);
}

TEST(JointCopy, RowsKeepMomentum) {
  Poses poses(kSeed);
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    if (std::string_view(of.name) == "gear") continue;  // its housing is not there
    JointRig rig(of);
    for (int i = 0; i < 50; ++i) {
      RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
      poses.shake(a, 1.0, 1.0);
      poses.shake(b, 1.0, 1.0);
      for (const JointRow& row : evaluate(rig.copy, a, b)) {
        const Vec3 made = row.turn_a_W + row.turn_b_W - (b.p_W - a.p_W).cross(row.n_W);
        EXPECT_LT(made.norm(), 1e-14) << "row " << row.number;
      }
    }
  }
}

TEST(JointCopy, KeepsTheSameLocksAtAllPoses) {
  Poses poses(kSeed);
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    JointRig rig(of);
    for (int i = 0; i < 50; ++i) {
      RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
      // The first pose is the one in which all errors are 0.
      if (i > 0) poses.shake(b, 0.01, 0.1);
      const Rows rows = evaluate(rig.copy, a, b);
      EXPECT_EQ(std::count_if(rows.begin(), rows.end(), isRigidLock), of.locked);
    }
  }
}

TEST(JointCopy, ClosesWhatIsOff) {
  std::cout << "seed " << kSeed << '\n';
  Poses poses(kSeed);
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    JointRig rig(of);
    for (int i = 0; i < 50; ++i) {
      RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
      poses.shake(b, 0.05, 0.4);
      EXPECT_LT(closeJoint(rig.copy, a, b, 8), 1e-13);
    }
  }
}

TEST(JointCopy, ReadsItsHostOnly) {
  for (const JointCase& of : test::makeJointCases()) {
    SCOPED_TRACE(of.name);
    JointRig rig(of);
    std::vector<unsigned char> joint(of.bytes), body(sizeof(btRigidBody));
    std::memcpy(joint.data(), static_cast<const void*>(rig.joint.get()), joint.size());
    std::memcpy(body.data(), static_cast<const void*>(&rig.a), body.size());
    JointCopy copy(*rig.joint, rig.solver);
    copy.refresh(*rig.joint, rig.solver);
    evaluate(copy, JointRig::stateOf(rig.a), JointRig::stateOf(rig.b));
    EXPECT_EQ(std::memcmp(joint.data(), static_cast<const void*>(rig.joint.get()), joint.size()),
              0);
    EXPECT_EQ(std::memcmp(body.data(), static_cast<const void*>(&rig.a), body.size()), 0);
  }
}

TEST(JointCopy, KnowsExactTypesOnly) {
  class OwnHinge final : public btHingeConstraint {
   public:
    using btHingeConstraint::btHingeConstraint;
  };
  test::BulletRig rig;
  btRigidBody &a = rig.addCube(1.0), &b = rig.addCube(1.0);
  OwnHinge own(a, b, test::frameInA(), test::frameInB());
  EXPECT_FALSE(JointCopy::isKnown(own));
  for (const JointCase& of : test::makeJointCases())
    EXPECT_TRUE(JointCopy::isKnown(*of.make(a, b)));
}

}  // namespace
}  // namespace tandem
