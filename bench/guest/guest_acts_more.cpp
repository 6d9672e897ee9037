#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_scalar.h"
#include "bench/guest/guest_world.h"

// Forces that follow the motion, bodies that leave before their joints, frames of joints.

namespace tandem::demos::bench {
namespace {

void toggleSpring(GuestWorld& world, Draw& draw) { world.toggleSpring(draw); }

/// The order of a host that forgets the joint, or tidies it up later.
void leaveBeforeJoint(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  const bool is_remade = draw.chance(0.5);
  if (!body.is_in_world) return;
  world.removeBeforeJoints(body);
  if (!is_remade) return;
  world.destroy(body);
  world.make(body);
  world.add(body);
}

btTransform shifted(const btTransform& frame, const btVector3& way, const btQuaternion& turn) {
  return btTransform(frame.getRotation() * turn, frame.getOrigin() + way);
}

/// Moves where a joint sits in its bodies, by up to a centimetre and some degrees.
void moveFrames(GuestWorld& world, Draw& draw) {
  const int which = draw.count(0, 1000);
  const btVector3 way = toBullet(Vec3(draw.even(0.0, 0.01) * draw.direction()));
  const btQuaternion turn(toBullet(draw.direction()), scalar(draw.even(0.0, 0.1)));
  const bool of_b = draw.chance(0.5);
  if (world.joints().empty()) return;
  btTypedConstraint& joint =
      *world.joints()[static_cast<std::size_t>(which) % world.joints().size()];
  // A host wakes what it is about to move.
  joint.getRigidBodyA().activate();
  joint.getRigidBodyB().activate();
  const auto setFrames = [&](auto& of, const btTransform& a, const btTransform& b) {
    of.setFrames(of_b ? a : shifted(a, way, turn), of_b ? shifted(b, way, turn) : b);
  };
  switch (joint.getConstraintType()) {
    case POINT2POINT_CONSTRAINT_TYPE: {
      auto& pin = static_cast<btPoint2PointConstraint&>(joint);
      of_b ? pin.setPivotB(pin.getPivotInB() + way) : pin.setPivotA(pin.getPivotInA() + way);
      break;
    }
    case HINGE_CONSTRAINT_TYPE: {
      auto& hinge = static_cast<btHingeConstraint&>(joint);
      setFrames(hinge, hinge.getAFrame(), hinge.getBFrame());
      break;
    }
    case SLIDER_CONSTRAINT_TYPE: {
      auto& slider = static_cast<btSliderConstraint&>(joint);
      setFrames(slider, slider.getFrameOffsetA(), slider.getFrameOffsetB());
      break;
    }
    case CONETWIST_CONSTRAINT_TYPE: {
      auto& cone = static_cast<btConeTwistConstraint&>(joint);
      setFrames(cone, cone.getAFrame(), cone.getBFrame());
      break;
    }
    case D6_CONSTRAINT_TYPE:
    case D6_SPRING_CONSTRAINT_TYPE: {
      auto& free = static_cast<btGeneric6DofConstraint&>(joint);
      setFrames(free, free.getFrameOffsetA(), free.getFrameOffsetB());
      break;
    }
    case D6_SPRING_2_CONSTRAINT_TYPE: {
      auto& free = static_cast<btGeneric6DofSpring2Constraint&>(joint);
      setFrames(free, free.getFrameOffsetA(), free.getFrameOffsetB());
      break;
    }
    default:
      break;
  }
}

}  // namespace

void appendMoreActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"spring of the host comes or goes", false, toggleSpring},
                           {"body leaves before its joint", false, leaveBeforeJoint},
                           {"frames of a joint", false, moveFrames}});
}

}  // namespace tandem::demos::bench
