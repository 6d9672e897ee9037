#include "bench/guest/guest_world.h"

// Joints of a host.

namespace tandem::demos::bench {
namespace {

/// Frame of a joint in a body: half way to the other, with drawn axes for both.
btTransform frameIn(const btRigidBody& body, const btVector3& middle) {
  btTransform frame = btTransform::getIdentity();
  frame.setOrigin(body.getWorldTransform().inverse() * middle);
  frame.setBasis(body.getWorldTransform().getBasis().transpose());
  return frame;
}

std::unique_ptr<btTypedConstraint> makeJoint(int kind, btRigidBody& a, btRigidBody& b,
                                             const btVector3& middle) {
  const btTransform in_a = frameIn(a, middle), in_b = frameIn(b, middle);
  switch (kind) {
    case 0:
      return std::make_unique<btPoint2PointConstraint>(a, b, in_a.getOrigin(), in_b.getOrigin());
    case 1:
      return std::make_unique<btHingeConstraint>(a, b, in_a, in_b);
    case 2:
      return std::make_unique<btSliderConstraint>(a, b, in_a, in_b, true);
    case 3:
      return std::make_unique<btConeTwistConstraint>(a, b, in_a, in_b);
    case 4:
      return std::make_unique<btGeneric6DofConstraint>(a, b, in_a, in_b, true);
    case 5:
      return std::make_unique<btGeneric6DofSpringConstraint>(a, b, in_a, in_b, true);
    case 6:
      return std::make_unique<btGeneric6DofSpring2Constraint>(a, b, in_a, in_b);
    case 7:
      return std::make_unique<btFixedConstraint>(a, b, in_a, in_b);
    default:
      return std::make_unique<btPoint2PointConstraint>(a, in_a.getOrigin());
  }
}

}  // namespace

/// A joint between two bodies where they are at the start: their present states may differ from the
/// twin's, and a joint must not.
void GuestWorld::addJoint(Draw& draw) {
  GuestBody& a = drawDynamicBody(draw);
  GuestBody& b = drawDynamicBody(draw);
  const int kind = draw.count(0, 8);
  const bool disables_contact = draw.chance(0.5);
  if (&a == &b || !a.is_in_world || !b.is_in_world || a.plan.role == GuestRole::kFar ||
      b.plan.role == GuestRole::kFar)
    return;
  const btVector3 middle =
      (a.rigid->getWorldTransform().getOrigin() + b.rigid->getWorldTransform().getOrigin()) / 2;
  joints_.push_back(makeJoint(kind, *a.rigid, *b.rigid, middle));
  world().addConstraint(joints_.back().get(), disables_contact);
}

void GuestWorld::removeJointsOf(const GuestBody& body) {
  for (std::size_t j = joints_.size(); j-- > 0;)
    if (&joints_[j]->getRigidBodyA() == body.rigid || &joints_[j]->getRigidBodyB() == body.rigid)
      removeJoint(j);
}

void GuestWorld::removeBeforeJoints(GuestBody& body) {
  removeTiesOf(body);
  world().removeRigidBody(body.rigid);
  body.is_in_world = false;
  removeJointsOf(body);
}

void GuestWorld::removeJoint(std::size_t index) {
  world().removeConstraint(joints_[index].get());
  joints_.erase(joints_.begin() + static_cast<std::ptrdiff_t>(index));
}

}  // namespace tandem::demos::bench
