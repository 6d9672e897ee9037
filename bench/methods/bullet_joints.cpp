#include "bench/methods/bullet_joints.h"

#include "tandem/bullet_bridge/convert.h"

namespace tandem::demos::bench {
namespace {

/// A frame at `pivot_W` whose x is `x_W`, in a body.
btTransform makeFrame(const btRigidBody& body, const Vec3& pivot_W, const Vec3& x_W) {
  const Quat q_W = Quat::FromTwoVectors(Vec3::UnitX(), x_W);
  return body.getCenterOfMassTransform().inverse() * toBullet(pivot_W, q_W);
}

btVector3 toFrame(const btRigidBody& body, const Vec3& p_W) {
  return body.getCenterOfMassTransform().inverse() * toBullet(p_W);
}

btVector3 turnToFrame(const btRigidBody& body, const Vec3& n_W) {
  return body.getCenterOfMassTransform().getBasis().transpose() * toBullet(n_W);
}

}  // namespace

BulletJoints::BulletJoints(const BenchScene& scene, btDynamicsWorld& world,
                           const std::vector<std::unique_ptr<btRigidBody>>& bodies)
    : world_(world) {
  for (const BenchJoint& joint : scene.joints) {
    btRigidBody* b = joint.b ? bodies[*joint.b].get() : nullptr;
    if (joint.kind == BenchJointKind::kHinge)
      addHinge(joint, *bodies[joint.a], b);
    else
      addSlider(joint, *bodies[joint.a], b);
    world_.addConstraint(joints_.back().get(), true);
  }
}

BulletJoints::~BulletJoints() {
  for (const auto& joint : joints_) world_.removeConstraint(joint.get());
}

void BulletJoints::addHinge(const BenchJoint& joint, btRigidBody& a, btRigidBody* b) {
  const btVector3 pivot_A = toFrame(a, joint.pivot_W);
  const btVector3 axis_A = turnToFrame(a, Vec3::UnitY());
  auto hinge = b ? std::make_unique<btHingeConstraint>(a, *b, pivot_A, toFrame(*b, joint.pivot_W),
                                                       axis_A, turnToFrame(*b, Vec3::UnitY()))
                 : std::make_unique<btHingeConstraint>(a, pivot_A, axis_A);
  // The last number is Bullet's bounce; the others are its defaults.
  if (joint.limit)
    hinge->setLimit(static_cast<btScalar>(joint.limit->low),
                    static_cast<btScalar>(joint.limit->high), btScalar(0.9), btScalar(0.3), 0);
  if (joint.motor) motors_.push_back({hinge.get(), *joint.motor});
  joints_.push_back(std::move(hinge));
}

/// Bullet's coordinate of a slider is the way of its second body.
void BulletJoints::addSlider(const BenchJoint& joint, btRigidBody& a, btRigidBody* b) {
  const btTransform at_A = makeFrame(a, joint.pivot_W, joint.axis_W);
  auto slider = b ? std::make_unique<btSliderConstraint>(
                        *b, a, makeFrame(*b, joint.pivot_W, joint.axis_W), at_A, true)
                  : std::make_unique<btSliderConstraint>(a, at_A, true);
  if (joint.limit) {
    slider->setLowerLinLimit(static_cast<btScalar>(joint.limit->low));
    slider->setUpperLinLimit(static_cast<btScalar>(joint.limit->high));
  }
  if (joint.motor) {
    slider->setPoweredLinMotor(true);
    slider->setTargetLinMotorVelocity(static_cast<btScalar>(joint.motor->speed));
    slider->setMaxLinMotorForce(static_cast<btScalar>(joint.motor->force));
  }
  joints_.push_back(std::move(slider));
}

void BulletJoints::setStep(double h) {
  for (const HingeMotor& one : motors_)
    one.hinge->enableAngularMotor(true, static_cast<btScalar>(one.motor.speed),
                                  static_cast<btScalar>(h * one.motor.force));
}

}  // namespace tandem::demos::bench
