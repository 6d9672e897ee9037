#include "import/bullet/bullet_joint.h"

#include <algorithm>

#include "tandem/bullet_bridge/convert.h"

#include "terminal/usage_error.h"

namespace tandem::demos {
namespace {

/// Fills in the bodies of a joint in which `first` moves against `second`. True if `first` is the
/// world, so that the other one is named, and moves the other way.
bool nameBodies(const btRigidBody& first, const btRigidBody& second, const BulletNames& names,
                JointScenario& joint) {
  for (const btRigidBody* body : {&first, &second})
    if (const auto known = names.find(body); known != names.end())
      joint.bodies.push_back(known->second);
  return !names.contains(&first);
}

JointScenario makeHinge(btHingeConstraint& hinge, const BulletNames& names, double host_step) {
  JointScenario joint;
  const btTransform frame = hinge.getRigidBodyA().getWorldTransform() * hinge.getAFrame();
  const bool is_turned = nameBodies(hinge.getRigidBodyA(), hinge.getRigidBodyB(), names, joint);
  joint.at = fromBullet(frame.getOrigin());
  joint.axis = (is_turned ? -1.0 : 1.0) * fromBullet(frame.getBasis().getColumn(2));
  const double start = hinge.getHingeAngle();
  const double low = hinge.getLowerLimit() - start, high = hinge.getUpperLimit() - start;
  if (low < high && std::max(-low, high) <= 3.14) joint.limits = {low, high};
  if (hinge.getEnableAngularMotor() && hinge.getMotorTargetVelocity() == 0)
    joint.friction = hinge.getMaxMotorImpulse() / host_step;
  return joint;
}

/// Bullet's slider moves its second body against the first, along x of the first one's frame.
JointScenario makeSlider(btSliderConstraint& slider, const BulletNames& names) {
  JointScenario joint;
  joint.kind = "slider";
  const btTransform a = slider.getRigidBodyA().getWorldTransform() * slider.getFrameOffsetA();
  const btTransform b = slider.getRigidBodyB().getWorldTransform() * slider.getFrameOffsetB();
  const btVector3 axis = a.getBasis().getColumn(0);
  const bool is_turned = nameBodies(slider.getRigidBodyB(), slider.getRigidBodyA(), names, joint);
  joint.at = fromBullet(b.getOrigin());
  joint.axis = (is_turned ? -1.0 : 1.0) * fromBullet(axis);
  const double start = (b.getOrigin() - a.getOrigin()).dot(axis);
  const double low = slider.getLowerLinLimit() - start, high = slider.getUpperLinLimit() - start;
  if (low < high) joint.limits = {low, high};
  if (slider.getPoweredLinMotor() && slider.getTargetLinMotorVelocity() == 0)
    joint.friction = slider.getMaxLinMotorForce();
  return joint;
}

JointScenario makeBall(const btPoint2PointConstraint& ball, const BulletNames& names) {
  JointScenario joint;
  joint.kind = "ball";
  joint.at = fromBullet(ball.getRigidBodyA().getWorldTransform() * ball.getPivotInA());
  nameBodies(ball.getRigidBodyA(), ball.getRigidBodyB(), names, joint);
  return joint;
}

JointScenario makeWeld(btGeneric6DofSpring2Constraint& joint6, const BulletNames& names) {
  for (int i = 0; i < 6; ++i)
    if (!joint6.isLimited(i))
      throw UsageError("a joint of six directions is taken over only if all of them are locked");
  JointScenario joint;
  joint.kind = "weld";
  joint.at =
      fromBullet(joint6.getRigidBodyA().getWorldTransform() * joint6.getFrameOffsetA().getOrigin());
  nameBodies(joint6.getRigidBodyA(), joint6.getRigidBodyB(), names, joint);
  return joint;
}

}  // namespace

JointScenario makeJointScenario(btTypedConstraint& constraint, const BulletNames& names,
                                double host_step) {
  switch (constraint.getConstraintType()) {
    case HINGE_CONSTRAINT_TYPE:
      return makeHinge(static_cast<btHingeConstraint&>(constraint), names, host_step);
    case SLIDER_CONSTRAINT_TYPE:
      return makeSlider(static_cast<btSliderConstraint&>(constraint), names);
    case POINT2POINT_CONSTRAINT_TYPE:
      return makeBall(static_cast<const btPoint2PointConstraint&>(constraint), names);
    case D6_SPRING_2_CONSTRAINT_TYPE:
      return makeWeld(static_cast<btGeneric6DofSpring2Constraint&>(constraint), names);
    default:
      throw UsageError(
          "a joint of this kind is not taken over; use hinge, slider, point to point or fixed");
  }
}

}  // namespace tandem::demos
