#include "bridge/joint_cases.h"

#include <BulletDynamics/ConstraintSolver/btFixedConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGearConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHinge2Constraint.h>

namespace tandem::test {
namespace {

constexpr auto kAsMade = [](auto&) {};

/// Limits that drawn poses pass in some cases. Bullet's corrections are made whole.
constexpr auto kLimitHinge = [](auto& hinge) {
  hinge.setLimit(btScalar(-0.3), btScalar(0.4), btScalar(0.9), btScalar(1), btScalar(0));
};
constexpr auto kLimitSlider = [](auto& slider) {
  slider.setLowerLinLimit(btScalar(-0.03));
  slider.setUpperLinLimit(btScalar(0.05));
  slider.setLowerAngLimit(btScalar(-0.2));
  slider.setUpperAngLimit(btScalar(0.3));
};
constexpr auto kLimitSixDof = [](auto& joint) {
  joint.setLinearLowerLimit(btVector3(0, btScalar(-0.02), 1));
  joint.setLinearUpperLimit(btVector3(0, btScalar(0.03), -1));
  joint.setAngularLowerLimit(btVector3(btScalar(-0.2), btScalar(-0.1), 0));
  joint.setAngularUpperLimit(btVector3(btScalar(0.3), btScalar(0.4), 0));
};
constexpr auto kLockSixDof = [](auto& joint) {
  joint.setLinearLowerLimit(btVector3(0, 0, 0));
  joint.setLinearUpperLimit(btVector3(0, 0, 0));
  joint.setAngularLowerLimit(btVector3(0, 0, 0));
  joint.setAngularUpperLimit(btVector3(0, 0, 0));
};

auto limitCone(double span1, double span2, double twist) {
  return [=](btConeTwistConstraint& cone) {
    cone.setLimit(static_cast<btScalar>(span1), static_cast<btScalar>(span2),
                  static_cast<btScalar>(twist), btScalar(1), btScalar(1), btScalar(1));
  };
}

using Hinge = btHingeConstraint;
using Cone = btConeTwistConstraint;
using Spring2 = btGeneric6DofSpring2Constraint;

void addBuiltFromPoints(std::vector<JointCase>& cases) {
  cases.push_back({"point to point", sizeof(btPoint2PointConstraint),
                   [](btRigidBody& a, btRigidBody& b) {
                     return std::make_unique<btPoint2PointConstraint>(a, b, frameInA().getOrigin(),
                                                                      frameInB().getOrigin());
                   },
                   3, false});
  cases.push_back({"universal", sizeof(btUniversalConstraint),
                   [](btRigidBody& a, btRigidBody& b) {
                     const btTransform frame = a.getWorldTransform() * frameInA();
                     btVector3 axis1 = frame.getBasis().getColumn(0);
                     btVector3 axis2 = frame.getBasis().getColumn(1);
                     return std::make_unique<btUniversalConstraint>(a, b, frame.getOrigin(), axis1,
                                                                    axis2);
                   },
                   4, false});
  cases.push_back({"hinge 2", sizeof(btHinge2Constraint),
                   [](btRigidBody& a, btRigidBody& b) {
                     const btTransform frame = a.getWorldTransform() * frameInA();
                     btVector3 point = frame.getOrigin();
                     btVector3 axis1 = frame.getBasis().getColumn(0);
                     btVector3 axis2 = frame.getBasis().getColumn(1);
                     auto joint = std::make_unique<btHinge2Constraint>(a, b, point, axis1, axis2);
                     joint->setLowerLimit(btScalar(-0.2));
                     joint->setUpperLimit(btScalar(0.3));
                     return joint;
                   },
                   3, true});
  cases.push_back({"gear", sizeof(btGearConstraint),
                   [](btRigidBody& a, btRigidBody& b) {
                     return std::make_unique<btGearConstraint>(a, b, btVector3(1, 0, 0),
                                                               btVector3(0, 0, 1), btScalar(2.5));
                   },
                   1, false});
}

}  // namespace

std::vector<JointCase> makeJointCases() {
  std::vector<JointCase> cases;
  addBuiltFromPoints(cases);
  cases.push_back(makeCase<Hinge>("hinge", 5, false, kAsMade));
  cases.push_back(makeCase<Hinge>("hinge with limits", 5, true, kLimitHinge));
  cases.push_back(makeCase<Hinge>("hinge of frame a", 5, true, kLimitHinge, true));
  cases.push_back(makeCase<Hinge>("hinge without offset", 5, true, [](Hinge& hinge) {
    kLimitHinge(hinge);
    hinge.setUseFrameOffset(false);
  }));
  cases.push_back(makeCase<Hinge>("hinge locked at an angle", 6, false, [](Hinge& hinge) {
    hinge.setLimit(btScalar(0.2), btScalar(0.2), btScalar(0.9), btScalar(1), btScalar(0));
  }));
  cases.push_back(
      makeCase<btHingeAccumulatedAngleConstraint>("accumulated hinge", 5, true, kLimitHinge));
  cases.push_back(makeCase<btSliderConstraint>("slider", 5, false, kAsMade, true));
  cases.push_back(makeCase<btSliderConstraint>("slider with limits", 4, true, kLimitSlider, true));
  cases.push_back(makeCase<btSliderConstraint>("slider of frame b", 4, true, kLimitSlider, false));
  cases.push_back(makeCase<Cone>("cone twist", 3, false, kAsMade));
  cases.push_back(makeCase<Cone>("round cone", 3, true, limitCone(0.3, 0.3, -1.0)));
  cases.push_back(makeCase<Cone>("twist", 3, true, limitCone(0.3, 0.3, 0.2)));
  cases.back().is_exact = false;  // Bullet twists about x of b
  cases.push_back(makeCase<Cone>("flat cone", 3, true, limitCone(0.2, 0.5, 0.2)));
  cases.back().is_exact = false;  // Bullet's normal of an ellipse is none
  cases.push_back(makeCase<Cone>("cone about z", 4, true, limitCone(0.3, 0.0, 0.3)));
  cases.push_back(makeCase<Cone>("cone about y", 4, true, limitCone(0.0, 0.3, 0.3)));
  cases.back().is_exact = (cases.end() - 2)->is_exact = false;  // one row for two coordinates
  cases.push_back(makeCase<Cone>("cone without ways", 6, false, limitCone(0.0, 0.0, 0.0)));
  cases.back().is_exact = false;  // angles by arc cosine: half of the digits
  cases.push_back(makeCase<btGeneric6DofConstraint>("6-dof locked", 6, false, kLockSixDof, true));
  cases.push_back(makeCase<btGeneric6DofConstraint>("6-dof", 2, true, kLimitSixDof, true));
  cases.push_back(
      makeCase<btGeneric6DofSpringConstraint>("6-dof spring", 2, true, kLimitSixDof, true));
  constexpr const char* kOrders[] = {"spring 2 xyz", "spring 2 xzy", "spring 2 yxz",
                                     "spring 2 yzx", "spring 2 zxy", "spring 2 zyx"};
  for (int order = RO_XYZ; order <= RO_ZYX; ++order)
    cases.push_back(
        makeCase<Spring2>(kOrders[order], 2, true, kLimitSixDof, static_cast<RotateOrder>(order)));
  cases.push_back(makeCase<btFixedConstraint>("fixed", 6, false, kAsMade));
  return cases;
}

}  // namespace tandem::test
