#include "world/scene_joint.h"

namespace tandem::demos {
namespace {

/// Frames of a joint in its two bodies. Without a second body Bullet's fixed one is the first.
struct Frames {
  btRigidBody& a;
  btRigidBody& b;
  btTransform in_a, in_b;
};

Frames place(const btTransform& frame, const JointEnd& first, const JointEnd* second) {
  btRigidBody& b = *first.body;
  const btTransform in_b = first.start.inverse() * frame;
  if (!second) return {btTypedConstraint::getFixedBody(), b, frame, in_b};
  return {*second->body, b, second->start.inverse() * frame, in_b};
}

std::unique_ptr<btTypedConstraint> makeHinge(const JointScenario& joint, const Frames& f,
                                             double host_step) {
  // Bullet measures how its first body has turned against the second one.
  auto hinge = std::make_unique<btHingeConstraint>(f.b, f.a, f.in_b, f.in_a);
  if (joint.limits)
    hinge->setLimit(static_cast<btScalar>((*joint.limits)[0]),
                    static_cast<btScalar>((*joint.limits)[1]));
  if (joint.friction > 0.0)
    hinge->enableAngularMotor(true, 0, static_cast<btScalar>(joint.friction * host_step));
  return hinge;
}

/// Bullet's slider moves along x of its frames.
std::unique_ptr<btTypedConstraint> makeSlider(const JointScenario& joint, const Frames& f) {
  const btTransform x_to_z(btQuaternion(btVector3(0, 1, 0), -SIMD_HALF_PI));
  auto slider =
      std::make_unique<btSliderConstraint>(f.a, f.b, f.in_a * x_to_z, f.in_b * x_to_z, true);
  // Bullet's free slider has its lower limit above the upper one.
  slider->setLowerLinLimit(joint.limits ? static_cast<btScalar>((*joint.limits)[0]) : btScalar(1));
  slider->setUpperLinLimit(joint.limits ? static_cast<btScalar>((*joint.limits)[1]) : btScalar(-1));
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  slider->setPoweredLinMotor(joint.friction > 0.0);
  slider->setMaxLinMotorForce(static_cast<btScalar>(joint.friction));
  return slider;
}

}  // namespace

std::unique_ptr<btTypedConstraint> makeJoint(const JointScenario& joint, const btTransform& frame,
                                             const JointEnd& first, const JointEnd* second,
                                             double host_step) {
  const Frames f = place(frame, first, second);
  if (joint.kind == "hinge") return makeHinge(joint, f, host_step);
  if (joint.kind == "slider") return makeSlider(joint, f);
  if (joint.kind == "weld") return std::make_unique<btFixedConstraint>(f.a, f.b, f.in_a, f.in_b);
  return std::make_unique<btPoint2PointConstraint>(f.a, f.b, f.in_a.getOrigin(),
                                                   f.in_b.getOrigin());
}

}  // namespace tandem::demos
