// Motors, springs and softness of joint copies, at any step of the host.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "bridge/bullet_rows.h"
#include "bridge/joint_cases.h"

namespace tandem {
namespace {

using test::byWidth;
using test::HostRow;
using test::JointCase;
using test::JointRig;
using test::makeCase;
using Rows = std::vector<JointRow>;
using SixDof = btGeneric6DofConstraint;
using Spring1 = btGeneric6DofSpringConstraint;
using Spring2 = btGeneric6DofSpring2Constraint;

/// Poses at which b is a bit off, so that springs and servos pull.
Rows evaluateOff(JointRig& rig) {
  RigidState a = JointRig::stateOf(rig.a), b = JointRig::stateOf(rig.b);
  b.p_W += Vec3(0.003, -0.002, 0.004);
  b.q_WB = test::turn(0.02, Vec3(1.0, -2.0, 0.5)) * b.q_WB;
  rig.place(a, b);
  Rows rows;
  rig.copy.evaluate(JointRig::stateOf(rig.a), JointRig::stateOf(rig.b), rows);
  return rows;
}

/// The motor row of ours that goes along Bullet's row, with its sign.
const JointRow* findMotor(const Rows& rows, const HostRow& host) {
  for (const JointRow& row : rows)
    if (row.law == JointLaw::kMotor &&
        (row.n_W - host.n).norm() + (row.turn_b_W - host.turn_b).norm() < byWidth(1e-6, 1e-4))
      return &row;
  return nullptr;
}

constexpr auto kFree = [](auto& joint) {
  joint.setLinearLowerLimit(btVector3(1, 1, 1));
  joint.setLinearUpperLimit(btVector3(-1, -1, -1));
  joint.setAngularLowerLimit(btVector3(1, 1, 1));
  joint.setAngularUpperLimit(btVector3(-1, -1, -1));
};

void driveSixDof(SixDof& joint) {
  kFree(joint);
  joint.getTranslationalLimitMotor()->m_enableMotor[1] = true;
  joint.getTranslationalLimitMotor()->m_targetVelocity[1] = btScalar(0.7);
  joint.getTranslationalLimitMotor()->m_maxMotorForce[1] = btScalar(5);
  joint.getRotationalLimitMotor(2)->m_enableMotor = true;
  joint.getRotationalLimitMotor(2)->m_targetVelocity = btScalar(-0.4);
  joint.getRotationalLimitMotor(2)->m_maxMotorForce = btScalar(0.3);
}

void driveSpring2(Spring2& joint, bool is_servo) {
  kFree(joint);
  for (const int axis : {0, 4}) {
    joint.enableMotor(axis, true);
    joint.setServo(axis, is_servo);
    joint.setTargetVelocity(axis, btScalar(0.7));
    joint.setMaxMotorForce(axis, btScalar(5));
    joint.setServoTarget(axis, btScalar(0.2));
  }
}

std::vector<JointCase> makeDrivenCases() {
  const auto point = [](btRigidBody& a, btRigidBody& b) {
    auto joint = std::make_unique<btPoint2PointConstraint>(a, b, test::frameInA().getOrigin(),
                                                           test::frameInB().getOrigin());
    joint->m_setting.m_impulseClamp = btScalar(0.05);
    return joint;
  };
  return {
      {"clamped point", sizeof(btPoint2PointConstraint), point, 0, false},
      makeCase<btHingeConstraint>("hinge", 5, false,
                                  [](btHingeConstraint& hinge) {
                                    hinge.enableAngularMotor(true, btScalar(1.5), btScalar(0.02));
                                    hinge.setUseFrameOffset(false);
                                  }),
      makeCase<btHingeConstraint>(
          "hinge of frame a", 5, false,
          [](btHingeConstraint& hinge) {
            hinge.enableAngularMotor(true, btScalar(1.5), btScalar(0.02));
            hinge.setUseFrameOffset(false);
          },
          true),
      makeCase<btSliderConstraint>(
          "slider's turn", 4, false,
          [](btSliderConstraint& slider) {
            slider.setUpperAngLimit(btScalar(-1));
            slider.setPoweredAngMotor(true);
            slider.setTargetAngMotorVelocity(btScalar(1.5));
            slider.setMaxAngMotorForce(btScalar(0.2));
            slider.setUseFrameOffset(false);
          },
          true),
      makeCase<SixDof>("6-dof", 0, false, driveSixDof, true),
      makeCase<Spring1>(
          "6-dof spring", 0, false,
          [](Spring1& joint) {
            kFree(joint);
            for (const int axis : {1, 3}) {
              joint.enableSpring(axis, true);
              joint.setStiffness(axis, btScalar(30));
              joint.setDamping(axis, btScalar(0.4));
              joint.setEquilibriumPoint(axis, btScalar(0.05));
            }
          },
          true),
      makeCase<Spring2>("spring 2's motor", 0, false,
                        [](Spring2& joint) { driveSpring2(joint, false); }),
      makeCase<Spring2>("spring 2's servo", 0, false,
                        [](Spring2& joint) { driveSpring2(joint, true); }),
      makeCase<btConeTwistConstraint>("cone twist", 3, false,
                                      [](btConeTwistConstraint& cone) {
                                        cone.enableMotor(true);
                                        cone.setMaxMotorImpulse(btScalar(0.01));
                                        cone.setMotorTarget(
                                            btQuaternion(btVector3(0, 1, 0), btScalar(0.3)));
                                      }),
  };
}

// Speeds are equal, and forces are Bullet's impulses per step.
TEST(JointMotor, DrivesAsBulletDoes) {
  for (const JointCase& of : makeDrivenCases())
    for (const double rate : {60.0, 1000.0}) {
      SCOPED_TRACE(of.name + std::string(" at ") + std::to_string(rate));
      JointRig rig(of);
      rig.solver.dt = 1.0 / rate;
      rig.copy.refresh(*rig.joint, rig.solver);
      const Rows rows = evaluateOff(rig);
      int motors = 0;
      for (const HostRow& host : test::askBullet(*rig.joint, rate, rig.solver.erp)) {
        if (test::isUnbounded(host.low) || test::isUnbounded(host.high)) continue;
        ++motors;
        const JointRow* row = findMotor(rows, host);
        ASSERT_NE(row, nullptr);
        const double tolerance = byWidth(1e-9, 1e-3);  // [1]; a float's angle times a rate
        EXPECT_NEAR(row->speed, host.error, tolerance * (1.0 + std::abs(host.error)));
        EXPECT_NEAR(row->low, host.low * rate, tolerance * (1.0 + std::abs(row->low)));
        EXPECT_NEAR(row->high, host.high * rate, tolerance * (1.0 + std::abs(row->high)));
      }
      EXPECT_EQ(motors, std::count_if(rows.begin(), rows.end(), [](const JointRow& row) {
                  return row.law == JointLaw::kMotor;
                }));
      EXPECT_GT(motors, 0);
    }
}

// Slider: its target is a rate of the position of b from a, so a goes the other way.
TEST(JointMotor, DrivesASliderAlong) {
  JointRig rig(makeCase<btSliderConstraint>(
      "slider", 4, false,
      [](btSliderConstraint& slider) {
        slider.setLowerLinLimit(btScalar(1));
        slider.setUpperLinLimit(btScalar(-1));
        slider.setPoweredLinMotor(true);
        slider.setTargetLinMotorVelocity(btScalar(0.7));
        slider.setMaxLinMotorForce(btScalar(5));
      },
      true));
  for (const JointRow& row : evaluateOff(rig)) {
    if (row.law != JointLaw::kMotor) continue;
    EXPECT_NEAR(row.speed, -0.7, byWidth(1e-15, 1e-7));
    EXPECT_NEAR(row.high, 5.0, byWidth(1e-15, 1e-7));
    EXPECT_NEAR(row.low, -5.0, byWidth(1e-15, 1e-7));
    return;
  }
  FAIL() << "no motor";
}

// Springs of spring 2 are springs, whatever Bullet cuts off at its step.
TEST(JointMotor, HasSpringsOfSpring2) {
  JointRig rig(makeCase<Spring2>("spring 2", 0, false, [](Spring2& joint) {
    kFree(joint);
    for (const int axis : {2, 3}) {
      joint.enableSpring(axis, true);
      joint.setStiffness(axis, btScalar(4000), false);
      joint.setDamping(axis, btScalar(0.3), false);
      joint.setEquilibriumPoint(axis, btScalar(0.05));
    }
  }));
  const Rows rows = evaluateOff(rig);
  int springs = 0;
  for (const HostRow& host : test::askBullet(*rig.joint, 60.0, rig.solver.erp))
    for (const JointRow& row : rows) {
      if ((row.n_W - host.n).norm() + (row.turn_b_W - host.turn_b).norm() > byWidth(1e-6, 1e-4))
        continue;
      ++springs;
      EXPECT_NEAR(row.stiffness, 4000.0, 1e-3);
      EXPECT_NEAR(row.damping, 0.3, 1e-6);
      // Nothing moves, so one of Bullet's bounds is 0 and the other is the spring's impulse.
      EXPECT_NEAR(-row.stiffness * row.way, (host.low + host.high) * 60.0, byWidth(1e-9, 0.05));
    }
  EXPECT_EQ(springs, 2);
  EXPECT_EQ(rows.size(), 2u);
}

// A soft pin sags by m g / K, measured in Bullet: 0.5 kg, cfm 0.05 and erp 0.2.
TEST(JointMotor, SagsAsBulletDoes) {
  test::BulletRig rig;
  btRigidBody &a = rig.addCube(0.5), &b = rig.addCube(0.0);
  btPoint2PointConstraint joint(a, b, btVector3(0, 0, 0), btVector3(0, 0, 0));
  joint.setParam(BT_CONSTRAINT_CFM, btScalar(0.05));
  const std::pair<double, double> sags[] = {
      {60.0, 6.8125e-4}, {240.0, 4.2578e-5}, {1000.0, 2.4525e-6}};
  for (const auto& [rate, sag] : sags) {
    const JointCopy copy(joint, {1.0 / rate});
    Rows rows;
    copy.evaluate(JointRig::stateOf(a), JointRig::stateOf(b), rows);
    ASSERT_EQ(rows.size(), 3u);
    for (const JointRow& row : rows) {
      EXPECT_NEAR(0.5 * 9.81 / row.stiffness, sag, 1e-4 * sag);
      EXPECT_NEAR(row.damping / row.stiffness, 1.0 / (rate * 0.2), 1e-9);
    }
  }
}

TEST(JointMotor, TellsWhereItBreaks) {
  JointRig rig(makeCase<btFixedConstraint>("fixed", 6, false, [](auto&) {}));
  EXPECT_EQ(rig.copy.breakingForce(), HUGE_VAL);
  EXPECT_TRUE(rig.copy.isEnabled());
  rig.joint->setBreakingImpulseThreshold(btScalar(0.1));
  rig.joint->setEnabled(false);
  rig.copy.refresh(*rig.joint, {1.0 / 240.0});
  EXPECT_NEAR(rig.copy.breakingForce(), 24.0, 1e-5);
  EXPECT_FALSE(rig.copy.isEnabled());
}

// A limit is there before it is passed, at rest and in fast motion, and its way goes through 0.
TEST(JointMotor, ShowsLimitsBeforeTheyArePassed) {
  JointRig rig(makeCase<btSliderConstraint>(
      "slider", 4, true,
      [](btSliderConstraint& slider) {
        slider.setUpperLinLimit(btScalar(0.05));
        slider.setLowerLinLimit(btScalar(-0.05));
      },
      true));
  const RigidState a = JointRig::stateOf(rig.a), start = JointRig::stateOf(rig.b);
  const Vec3 along = a.q_WB * fromBullet(test::frameInA().getBasis().getColumn(0));
  const auto wayAt = [&](double position, double speed) {
    RigidState b = start;
    b.p_W += position * along;
    b.v_W = speed * along;
    Rows rows;
    rig.copy.evaluate(a, b, rows);
    for (const JointRow& row : rows)
      if (row.law == JointLaw::kLimit) return row.way;
    return HUGE_VAL;
  };
  EXPECT_EQ(wayAt(0.0, 0.0), HUGE_VAL);
  for (const double position : {0.042, 0.05, 0.06, 0.5})
    EXPECT_NEAR(wayAt(position, 0.0), 0.05 - position, 1e-7);
  EXPECT_NEAR(wayAt(0.0, 4.0), 0.05, 1e-7);
  EXPECT_EQ(wayAt(0.0, 2.0), HUGE_VAL);
}

TEST(JointMotor, ExchangesEnds) {
  JointRow row;
  row.n_W = Vec3(0, 0, 1);
  row.turn_a_W = Vec3(1, 2, 3);
  row.turn_b_W = Vec3(4, 5, 6);
  const JointRow other = exchangeEnds(row);
  EXPECT_EQ(other.n_W, Vec3(0, 0, -1));
  EXPECT_EQ(other.turn_a_W, row.turn_b_W);
  EXPECT_EQ(other.turn_b_W, row.turn_a_W);
}

}  // namespace
}  // namespace tandem
