#include "bench/guest/guest_arm.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <BulletCollision/CollisionShapes/btBoxShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_scalar.h"

namespace tandem::demos::bench {
namespace {

const Vec3 kHalfBase(0.05, 0.04, 0.03);  // [m]
constexpr double kDamping = 0.04;        // Bullet's default
constexpr btScalar kMargin = btScalar(0.001);

btVector3 inertiaOf(const Vec3& half, double mass) {
  btVector3 inertia(0, 0, 0);
  if (mass > 0.0) btBoxShape(toBullet(half)).calculateLocalInertia(scalar(mass), inertia);
  return inertia;
}

}  // namespace

GuestArm::GuestArm(const GuestArmPlan& plan, double step) : plan_(plan), step_(step) {
  const auto count = static_cast<int>(plan.links.size());
  body_ = std::make_unique<btMultiBody>(count, scalar(plan.base_mass),
                                        inertiaOf(kHalfBase, plan.base_mass), plan.base_mass == 0.0,
                                        plan.can_sleep);
  for (int i = 0; i < count; ++i) setUpLink(i, plan.links[static_cast<std::size_t>(i)]);
  body_->finalizeMultiDof();
  body_->setLinearDamping(scalar(plan.is_damped ? kDamping : 0.0));
  body_->setAngularDamping(scalar(plan.is_damped ? kDamping : 0.0));
  body_->setHasSelfCollision(false);
  if (plan.has_base_shape) addCollider(-1, kHalfBase);
  Draw draw(plan.seed, 0);
  for (int i = 0; i < count; ++i) {
    const GuestLinkPlan& link = plan.links[static_cast<std::size_t>(i)];
    if (link.has_shape) addCollider(i, link.half);
    if (draw.chance(0.6)) addMotor(i, draw);
    if (draw.chance(0.4)) addLimit(i, draw);
  }
  reset();
}

void GuestArm::setUpLink(int index, const GuestLinkPlan& link) {
  const btScalar mass = scalar(link.mass);
  const btVector3 inertia = inertiaOf(link.half, link.mass), axis = toBullet(link.axis);
  const btVector3 e = toBullet(link.to_joint), d = toBullet(link.to_centre);
  const btQuaternion straight = btQuaternion::getIdentity();
  switch (link.joint) {
    case GuestLinkJoint::kPrismatic:
      body_->setupPrismatic(index, mass, inertia, link.parent, straight, axis, e, d, true);
      break;
    case GuestLinkJoint::kSpherical:
      body_->setupSpherical(index, mass, inertia, link.parent, straight, e, d, true);
      break;
    case GuestLinkJoint::kPlanar:
      body_->setupPlanar(index, mass, inertia, link.parent, straight, axis, e, true);
      break;
    case GuestLinkJoint::kFixed:
      body_->setupFixed(index, mass, inertia, link.parent, straight, e, d);
      break;
    case GuestLinkJoint::kRevolute:
      body_->setupRevolute(index, mass, inertia, link.parent, straight, axis, e, d, true);
  }
}

void GuestArm::addCollider(int link, const Vec3& half) {
  shapes_.push_back(std::make_unique<btBoxShape>(toBullet(half)));
  shapes_.back()->setMargin(kMargin);
  colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(body_.get(), link));
  btMultiBodyLinkCollider& collider = *colliders_.back();
  collider.setCollisionShape(shapes_.back().get());
  if (link < 0) {
    body_->setBaseCollider(&collider);
  } else {
    body_->getLink(link).m_collider = &collider;
  }
}

void GuestArm::add(btMultiBodyDynamicsWorld& world) {
  if (world_) return;
  world_ = &world;
  world.addMultiBody(body_.get());
  for (const auto& collider : colliders_)
    world.addCollisionObject(collider.get(), btBroadphaseProxy::DefaultFilter,
                             btBroadphaseProxy::AllFilter);
  for (const Hold& hold : holds_) world.addMultiBodyConstraint(hold.constraint.get());
}

void GuestArm::remove() {
  if (!world_) return;
  for (const Hold& hold : holds_) world_->removeMultiBodyConstraint(hold.constraint.get());
  for (const auto& collider : colliders_) world_->removeCollisionObject(collider.get());
  world_->removeMultiBody(body_.get());
  world_ = nullptr;
}

void GuestArm::reset() {
  body_->clearVelocities();
  body_->setBasePos(toBullet(plan_.p_W));
  body_->setWorldToBaseRot(btQuaternion::getIdentity());
  for (int i = 0; i < body_->getNumLinks(); ++i) {
    btScalar q[4] = {0, 0, 0, 0};
    if (plan_.links[static_cast<std::size_t>(i)].joint == GuestLinkJoint::kSpherical) q[3] = 1;
    body_->setJointPosMultiDof(i, q);
  }
  body_->wakeUp();
  showPose();
}

void GuestArm::showPose() {
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  body_->forwardKinematics(turns, origins);
  body_->updateCollisionObjectWorldTransforms(turns, origins);
  if (world_) world_->updateAabbs();
}

void GuestArm::addTorque(int link, int dof, double torque) {
  body_->addJointTorqueMultiDof(link, dof, scalar(torque));
  torque_ += std::abs(torque);
}

void GuestArm::addForce(int link, const Vec3& f_W) {
  body_->addLinkForce(link, toBullet(f_W));
  force_ += f_W.norm();
}

}  // namespace tandem::demos::bench
