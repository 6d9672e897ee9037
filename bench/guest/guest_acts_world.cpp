#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_world.h"

// Worlds and joints.

namespace tandem::demos::bench {
namespace {

void setWorldGravity(GuestWorld& world, Draw& draw) {
  // Never the gravity that it has: the bodies that miss it cannot be known by its value.
  const Vec3 g_W(draw.even(-2.0, 2.0), 0.0, draw.even(-12.0, 0.0));
  world.setGravity(toBullet(g_W));
}

void setSolver(GuestWorld& world, Draw& draw) {
  btContactSolverInfo& info = world.world().getSolverInfo();
  switch (draw.count(0, 8)) {
    case 0:
      info.m_numIterations = draw.count(4, 50);
      break;
    case 1:
      info.m_splitImpulse = draw.count(0, 1);
      break;
    case 2:
      info.m_erp = info.m_erp2 = static_cast<btScalar>(draw.even(0.05, 0.8));
      break;
    case 3:
      info.m_solverMode ^= SOLVER_USE_2_FRICTION_DIRECTIONS;
      break;
    case 4:
      info.m_solverMode ^= SOLVER_RANDMIZE_ORDER;
      break;
    case 5:
      info.m_linearSlop = static_cast<btScalar>(draw.even(0.0, 1e-4));
      break;
    case 6:
      info.m_restitutionVelocityThreshold = static_cast<btScalar>(draw.even(0.0, 1.0));
      break;
    case 7:
      info.m_solverMode ^= SOLVER_USE_WARMSTARTING;
      break;
    default:
      info.m_minimumSolverBatchSize = draw.count(1, 128);
  }
}

void setDispatch(GuestWorld& world, Draw& draw) {
  btDispatcherInfo& info = world.world().getDispatchInfo();
  switch (draw.count(0, 3)) {
    case 0:
      info.m_useContinuous = !info.m_useContinuous;
      break;
    case 1:
      info.m_deterministicOverlappingPairs = !info.m_deterministicOverlappingPairs;
      break;
    case 2:
      info.m_enableSatConvex = !info.m_enableSatConvex;
      break;
    default:
      info.m_allowedCcdPenetration = static_cast<btScalar>(draw.even(0.0, 0.05));
  }
}

void setWorldFlags(GuestWorld& world, Draw& draw) {
  btDiscreteDynamicsWorld& bullet = world.world();
  switch (draw.count(0, 3)) {
    case 0:
      bullet.setForceUpdateAllAabbs(draw.chance(0.5));
      break;
    case 1:
      bullet.setSynchronizeAllMotionStates(draw.chance(0.5));
      break;
    case 2:
      bullet.setLatencyMotionStateInterpolation(draw.chance(0.5));
      break;
    default:
      bullet.setApplySpeculativeContactRestitution(draw.chance(0.5));
  }
}

void clearWorldForces(GuestWorld& world, Draw& draw) {
  world.world().clearForces();
  if (draw.chance(0.3)) world.world().applyGravity();
}

void synchronize(GuestWorld& world, Draw&) { world.world().synchronizeMotionStates(); }

void detect(GuestWorld& world, Draw&) {
  world.world().updateAabbs();
  world.world().performDiscreteCollisionDetection();
}

/// Asks for contact and rays, as sensors do.
void query(GuestWorld& world, Draw& draw) {
  struct Contacts final : btCollisionWorld::ContactResultCallback {
    btScalar addSingleResult(btManifoldPoint&, const btCollisionObjectWrapper*, int, int,
                             const btCollisionObjectWrapper*, int, int) override {
      return 0;
    }
  } contacts;
  GuestBody& body = world.drawBody(draw);
  if (body.is_in_world) world.world().contactTest(body.rigid, contacts);
  const btVector3 from(0, 0, 1), to(0, 0, -1);
  btCollisionWorld::AllHitsRayResultCallback rays(from, to);
  world.world().rayTest(from, to, rays);
}

void moveFloor(GuestWorld& world, Draw& draw) {
  world.moveFloor(static_cast<btScalar>(draw.even(-0.01, 0.002)));
}

void addJoint(GuestWorld& world, Draw& draw) { world.addJoint(draw); }

void removeJoint(GuestWorld& world, Draw& draw) {
  const int which = draw.count(0, 1000);
  const auto count = static_cast<int>(world.joints().size());
  if (count > 0) world.removeJoint(static_cast<std::size_t>(which % count));
}

btTypedConstraint* drawJoint(GuestWorld& world, Draw& draw) {
  const int which = draw.count(0, 1000);
  const auto count = static_cast<int>(world.joints().size());
  return count > 0 ? world.joints()[static_cast<std::size_t>(which % count)].get() : nullptr;
}

void setJoint(GuestWorld& world, Draw& draw) {
  btTypedConstraint* joint = drawJoint(world, draw);
  const int what = draw.count(0, 4);
  const auto value = static_cast<btScalar>(draw.even(0.0, 1.0));
  if (!joint) return;
  switch (what) {
    case 0:
      joint->setEnabled(!joint->isEnabled());
      break;
    case 1:
      joint->setBreakingImpulseThreshold(value);
      break;
    case 2:
      joint->setOverrideNumSolverIterations(static_cast<int>(value * 60));
      break;
    case 3:
      joint->enableFeedback(false);
      joint->setUserConstraintId(7);
      break;
    default:
      if (joint->getConstraintType() == POINT2POINT_CONSTRAINT_TYPE)
        joint->setParam(BT_CONSTRAINT_ERP, value, -1);
  }
}

void driveJoint(GuestWorld& world, Draw& draw) {
  btTypedConstraint* joint = drawJoint(world, draw);
  const auto speed = static_cast<btScalar>(draw.even(-5.0, 5.0));
  const auto limit = static_cast<btScalar>(draw.even(0.1, 1.5));
  if (!joint) return;
  if (joint->getConstraintType() == HINGE_CONSTRAINT_TYPE) {
    auto& hinge = static_cast<btHingeConstraint&>(*joint);
    hinge.enableAngularMotor(true, speed, btScalar(0.01));
    hinge.setLimit(-limit, limit);
  } else if (joint->getConstraintType() == SLIDER_CONSTRAINT_TYPE) {
    auto& slider = static_cast<btSliderConstraint&>(*joint);
    slider.setPoweredLinMotor(true);
    slider.setTargetLinMotorVelocity(speed / 10);
    slider.setMaxLinMotorForce(btScalar(1));
  } else if (joint->getConstraintType() == D6_CONSTRAINT_TYPE) {
    auto& free = static_cast<btGeneric6DofConstraint&>(*joint);
    free.setLinearLowerLimit(btVector3(-limit, 0, 0) / 100);
    free.setLinearUpperLimit(btVector3(limit, 0, 0) / 100);
  } else if (joint->getConstraintType() == CONETWIST_CONSTRAINT_TYPE) {
    static_cast<btConeTwistConstraint&>(*joint).setLimit(limit, limit, limit);
  }
}

}  // namespace

void appendWorldActs(std::vector<GuestAct>& acts) {
  acts.insert(
      acts.end(),
      {{"gravity of the world", true, setWorldGravity},
       {"solver settings", false, setSolver},
       {"dispatch settings", false, setDispatch},
       {"flags of the world", false, setWorldFlags},
       {"clear the world's forces", false, clearWorldForces},
       {"synchronize motion states", false, synchronize},
       {"collision detection by hand", false, detect},
       {"contact test and rays", false, query},
       {"move the floor", false, moveFloor},
       {"floor away or back", false, [](GuestWorld& world, Draw&) { world.toggleFloor(); }},
       {"many bodies come or go", false, [](GuestWorld& world, Draw&) { world.toggleThrong(); }},
       {"ghost comes or goes", false, [](GuestWorld& world, Draw&) { world.toggleGhost(); }},
       {"action comes or goes", false,
        [](GuestWorld& world, Draw& draw) { world.toggleAction(draw); }},
       {"another solver", false, [](GuestWorld& world, Draw&) { world.replaceSolver(); }},
       {"save the state", false, [](GuestWorld& world, Draw&) { world.save(); }},
       {"restore the state", false, [](GuestWorld& world, Draw&) { world.restore(); }},
       {"reset of the world", false, [](GuestWorld& world, Draw&) { world.reset(); }}});
}

void appendJointActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"joint added", false, addJoint},
                           {"joint removed", false, removeJoint},
                           {"joint settings", false, setJoint},
                           {"motor and limits of a joint", false, driveJoint}});
}

}  // namespace tandem::demos::bench
