#include "joints/moved_frames.h"

#include <algorithm>

#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "bodies/body_look.h"
#include "world/world_access.h"

namespace tandem {
namespace {

/// Frames that stood so long do not move any more [s].
constexpr double kStandsAfter = 0.5;
/// Smaller moves in a step are rounding of a host that computes its frames anew [m, rad].
constexpr btScalar kSame = btScalar(1e-6);

bool isNear(const btVector3& a, const btVector3& b) {
  const btVector3 apart = (a - b).absolute();
  return apart.x() < kSame && apart.y() < kSame && apart.z() < kSame;
}

bool isNear(const btTransform& a, const btTransform& b) {
  return isNear(a.getOrigin(), b.getOrigin()) && isNear(a.getBasis()[0], b.getBasis()[0]) &&
         isNear(a.getBasis()[1], b.getBasis()[1]) && isNear(a.getBasis()[2], b.getBasis()[2]);
}

/// Null: forces do not move it.
const btRigidBody* findPulled(const btRigidBody& body) { return isDynamic(body) ? &body : nullptr; }

}  // namespace

/// False for joints without frames.
bool MovedFrames::read(btTypedConstraint& joint, Frames& frames) noexcept {
  frames.a = frames.b = btTransform::getIdentity();
  const auto readOf = [&](auto& known) {
    frames = {known.getFrameOffsetA(), known.getFrameOffsetB()};
  };
  switch (joint.getConstraintType()) {
    case POINT2POINT_CONSTRAINT_TYPE: {
      const auto& point = static_cast<btPoint2PointConstraint&>(joint);
      frames.a.setOrigin(point.getPivotInA());
      frames.b.setOrigin(point.getPivotInB());
      break;
    }
    case HINGE_CONSTRAINT_TYPE: {
      auto& hinge = static_cast<btHingeConstraint&>(joint);
      frames = {hinge.getAFrame(), hinge.getBFrame()};
      break;
    }
    case CONETWIST_CONSTRAINT_TYPE: {
      auto& cone = static_cast<btConeTwistConstraint&>(joint);
      frames = {cone.getAFrame(), cone.getBFrame()};
      break;
    }
    case SLIDER_CONSTRAINT_TYPE:
      readOf(static_cast<btSliderConstraint&>(joint));
      break;
    case D6_CONSTRAINT_TYPE:
    case D6_SPRING_CONSTRAINT_TYPE:
      readOf(static_cast<btGeneric6DofConstraint&>(joint));
      break;
    case D6_SPRING_2_CONSTRAINT_TYPE:
      readOf(static_cast<btGeneric6DofSpring2Constraint&>(joint));
      break;
    default:
      return false;
  }
  if (isFixed(joint.getRigidBodyA()))
    frames.a = joint.getRigidBodyA().getWorldTransform() * frames.a;
  if (isFixed(joint.getRigidBodyB()))
    frames.b = joint.getRigidBodyB().getWorldTransform() * frames.b;
  return true;
}

void MovedFrames::look(double dt) {
  next_.clear();
  moving_.clear();
  for (int i = 0; i < host_.getNumConstraints(); ++i) {
    btTypedConstraint& joint = *host_.getConstraint(i);
    Known known{&joint, {}, 0.0};
    if (!read(joint, known.frames)) continue;
    if (const Known* before = find(&joint, next_.size())) {
      const bool has_moved =
          !isNear(before->frames.a, known.frames.a) || !isNear(before->frames.b, known.frames.b);
      known.time_left = has_moved ? kStandsAfter : before->time_left - dt;
    }
    if (known.time_left > 0.0)
      moving_.push_back(
          {&joint, findPulled(joint.getRigidBodyA()), findPulled(joint.getRigidBodyB())});
    next_.push_back(known);
  }
  joints_.swap(next_);
}

/// Joints hardly ever change their order: `hint` is the likely place.
const MovedFrames::Known* MovedFrames::find(const btTypedConstraint* joint,
                                            std::size_t hint) const noexcept {
  if (hint < joints_.size() && joints_[hint].joint == joint) return &joints_[hint];
  const auto known = std::find_if(joints_.begin(), joints_.end(),
                                  [&](const Known& other) { return other.joint == joint; });
  return known == joints_.end() ? nullptr : &*known;
}

bool MovedFrames::isMoving(const btTypedConstraint& joint) const noexcept {
  return std::any_of(moving_.begin(), moving_.end(),
                     [&](const Moving& moving) { return moving.joint == &joint; });
}

bool MovedFrames::isDragged(const btRigidBody& body) const noexcept {
  return std::any_of(moving_.begin(), moving_.end(),
                     [&](const Moving& moving) { return moving.a == &body || moving.b == &body; });
}

}  // namespace tandem
