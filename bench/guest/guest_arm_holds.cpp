#include <algorithm>
#include <cstddef>
#include <utility>

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/Featherstone/btMultiBodySliderConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointLimit.h>
#include <BulletDynamics/Featherstone/btMultiBodySphericalJointMotor.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_arm.h"
#include "bench/guest/guest_scalar.h"

// Motors, limits and ties of an arm.

namespace tandem::demos::bench {
namespace {

constexpr double kLimitForce = 100.0;  // of a spherical limit [N m]
constexpr double kTieForce = 500.0;    // of half the ties [N]
constexpr double kGap = 0.01;          // a tie may be open by this [m]

/// Two ends of a tie, each in the frame of what it holds.
struct Ends {
  btVector3 on_a, on_b;
  btMatrix3x3 frame_a = btMatrix3x3::getIdentity(), frame_b;
};

/// `other`: an arm or a body, or null for the world. `more`: the link of an arm.
template <typename Other, typename... More>
std::unique_ptr<btMultiBodyConstraint> makeTie(int kind, btMultiBody& arm, int link, Other* other,
                                               const Ends& ends, const btVector3& axis,
                                               More... more) {
  if (kind == 0)
    return std::make_unique<btMultiBodyPoint2Point>(&arm, link, other, more..., ends.on_a,
                                                    ends.on_b);
  if (kind == 1)
    return std::make_unique<btMultiBodyFixedConstraint>(&arm, link, other, more..., ends.on_a,
                                                        ends.on_b, ends.frame_a, ends.frame_b);
  return std::make_unique<btMultiBodySliderConstraint>(&arm, link, other, more..., ends.on_a,
                                                       ends.on_b, ends.frame_a, ends.frame_b, axis);
}

}  // namespace

void GuestArm::addHold(std::unique_ptr<btMultiBodyConstraint> one, const btRigidBody* body,
                       bool is_tie) {
  if (world_) world_->addMultiBodyConstraint(one.get());
  was_tied_ |= is_tie;
  holds_.push_back({std::move(one), body, is_tie});
}

void GuestArm::addMotor(int link, Draw& draw) {
  const GuestLinkJoint joint = plan_.links[static_cast<std::size_t>(link)].joint;
  const btScalar impulse = scalar(draw.log(0.1, 20.0) * step_);
  if (joint == GuestLinkJoint::kSpherical) {
    auto motor = std::make_unique<btMultiBodySphericalJointMotor>(body_.get(), link, impulse);
    const Quat target(Eigen::AngleAxisd(draw.even(0.0, 2.0), draw.direction()));
    motor->setPositionTarget(toBullet(target), scalar(draw.even(0.0, 1.0)));
    if (draw.chance(0.5)) motor->setDamping(btVector3(1, 1, 1) * scalar(draw.even(0.1, 1.0)));
    addHold(std::move(motor), nullptr, false);
  } else if (joint == GuestLinkJoint::kRevolute || joint == GuestLinkJoint::kPrismatic) {
    const btScalar speed = scalar(draw.even(-1.0, 1.0));
    addHold(std::make_unique<btMultiBodyJointMotor>(body_.get(), link, speed, impulse), nullptr,
            false);
  }
}

void GuestArm::addLimit(int link, Draw& draw) {
  const GuestLinkJoint joint = plan_.links[static_cast<std::size_t>(link)].joint;
  const btScalar low = scalar(draw.even(-1.0, -0.05)), high = scalar(draw.even(0.05, 1.0));
  if (joint == GuestLinkJoint::kSpherical) {
    addHold(std::make_unique<btMultiBodySphericalJointLimit>(body_.get(), link, -low, high,
                                                             3 * high, scalar(kLimitForce * step_)),
            nullptr, false);
  } else if (joint == GuestLinkJoint::kRevolute || joint == GuestLinkJoint::kPrismatic) {
    addHold(std::make_unique<btMultiBodyJointLimitConstraint>(body_.get(), link, low, high),
            nullptr, false);
  }
}

void GuestArm::addTie(int link, btRigidBody* body, int other, Draw& draw) {
  const int kind = draw.count(0, 2);
  const btVector3 gap = toBullet(Vec3(draw.even(0.0, kGap) * draw.direction()));
  const btVector3 axis = toBullet(draw.direction());
  const bool is_weak = draw.chance(0.5);
  if (link == other) return;
  // The middle of both ends, so that the tie is nearly closed.
  btVector3 place = body_->localPosToWorld(link, btVector3(0, 0, 0));
  Ends ends;
  ends.frame_b = body_->localFrameToWorld(link, btMatrix3x3::getIdentity());
  if (body) {
    const btTransform& pose = body->getWorldTransform();
    place = (place + pose.getOrigin()) / 2;
    ends.on_b = pose.inverse() * (place + gap);
    ends.frame_b = pose.getBasis().transpose() * ends.frame_b;
  } else if (other >= 0) {
    place = (place + body_->localPosToWorld(other, btVector3(0, 0, 0))) / 2;
    ends.on_b = body_->worldPosToLocal(other, place + gap);
    ends.frame_b =
        body_->localFrameToWorld(other, btMatrix3x3::getIdentity()).transpose() * ends.frame_b;
  } else {
    ends.on_b = place + gap;
  }
  ends.on_a = body_->worldPosToLocal(link, place);
  auto tie = other >= 0 ? makeTie(kind, *body_, link, body_.get(), ends, axis, other)
                        : makeTie(kind, *body_, link, body, ends, axis);
  if (is_weak) tie->setMaxAppliedImpulse(scalar(kTieForce * step_));
  addHold(std::move(tie), body, true);
}

void GuestArm::removeHold(std::size_t index) {
  if (world_) world_->removeMultiBodyConstraint(holds_[index].constraint.get());
  holds_.erase(holds_.begin() + static_cast<std::ptrdiff_t>(index));
}

void GuestArm::removeAllHolds() {
  while (!holds_.empty()) removeHold(holds_.size() - 1);
}

void GuestArm::removeTiesOf(const btRigidBody& body) {
  for (std::size_t i = holds_.size(); i-- > 0;)
    if (holds_[i].body == &body) removeHold(i);
}

}  // namespace tandem::demos::bench
