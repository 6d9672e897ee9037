#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_world.h"

// Places, velocities, forces, activation, and bodies that come and go.

namespace tandem::demos::bench {
namespace {

btVector3 drawAny(Draw& draw, double most) {
  return toBullet(Vec3(draw.even(0.0, most) * draw.direction()));
}

/// A place above the floor in the scene.
btTransform drawPose(Draw& draw) {
  const Vec3 p_W(draw.even(-0.12, 0.12), draw.even(-0.12, 0.12), draw.even(0.05, 0.25));
  return toBullet(p_W, draw.rotation());
}

/// True if the body is a mover or stands: only dynamic ones are placed.
btRigidBody& pick(GuestWorld& world, Draw& draw) { return *world.drawDynamicBody(draw).rigid; }

void teleport(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  const btTransform pose = drawPose(draw);
  rigid.setWorldTransform(pose);
  if (draw.chance(0.7)) rigid.setInterpolationWorldTransform(pose);
  if (draw.chance(0.5)) rigid.setLinearVelocity(btVector3(0, 0, 0));
  if (draw.chance(0.5)) rigid.activate(true);
}

void teleportCentre(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.setCenterOfMassTransform(drawPose(draw));
}

void proceed(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.proceedToTransform(drawPose(draw));
}

void translate(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  btVector3 way = drawAny(draw, 0.05);
  way.setZ(btFabs(way.z()));
  rigid.translate(way);
}

void useMotionState(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  body.motion_state.m_graphicsWorldTrans = drawPose(draw);
  body.rigid->setMotionState(body.rigid->getMotionState() ? nullptr : &body.motion_state);
}

void setVelocity(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.activate(true);
  rigid.setLinearVelocity(drawAny(draw, 1.5));
  rigid.setAngularVelocity(drawAny(draw, 20.0));
}

void setVelocityAsleep(GuestWorld& world, Draw& draw) {
  pick(world, draw).setLinearVelocity(drawAny(draw, 0.5));
}

void setHugeVelocity(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.activate(true);
  rigid.setLinearVelocity(drawAny(draw, draw.log(10.0, 300.0)));
  rigid.setAngularVelocity(drawAny(draw, draw.log(10.0, 300.0)));
}

void setInterpolation(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.setInterpolationLinearVelocity(drawAny(draw, 1.0));
  rigid.setInterpolationAngularVelocity(drawAny(draw, 1.0));
}

void giveImpulse(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  const btVector3 impulse = drawAny(draw, body.mass * draw.log(0.1, 2.0));
  if (draw.chance(0.7)) body.rigid->activate();
  body.rigid->applyImpulse(impulse, drawAny(draw, body.plan.size));
  body.rigid->applyTorqueImpulse(drawAny(draw, 1e-4));
}

void giveForce(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  const btVector3 force = drawAny(draw, body.mass * draw.log(1.0, 100.0));
  if (draw.chance(0.7)) body.rigid->activate();
  body.rigid->applyForce(force, drawAny(draw, body.plan.size));
  body.rigid->applyTorque(drawAny(draw, 0.01));
}

void givePush(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.setPushVelocity(drawAny(draw, 0.1));
  rigid.setTurnVelocity(drawAny(draw, 0.1));
}

void clearForces(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.clearForces();
  if (draw.chance(0.5)) rigid.applyGravity();
}

void integrateOnce(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.integrateVelocities(static_cast<btScalar>(draw.even(0.0, 0.01)));
  rigid.applyDamping(static_cast<btScalar>(draw.even(0.0, 0.01)));
}

void saveKinematic(GuestWorld& world, Draw& draw) {
  world.drawBody(draw).rigid->saveKinematicState(btScalar(0.01));
}

void setGravity(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  world.noteGravityOf(body);
  body.rigid->setGravity(btVector3(0, 0, static_cast<btScalar>(draw.even(-12.0, 2.0))));
}

void flipGravity(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  btRigidBody& rigid = *body.rigid;
  world.noteGravityOf(body);
  rigid.setFlags(rigid.getFlags() ^ BT_DISABLE_WORLD_GRAVITY);
  if (draw.chance(0.5)) rigid.clearGravity();
}

void setGyroscopic(GuestWorld& world, Draw& draw) {
  constexpr int kFlags[] = {0, BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT,
                            BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD,
                            BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY};
  btRigidBody& rigid = pick(world, draw);
  rigid.setFlags((rigid.getFlags() & BT_DISABLE_WORLD_GRAVITY) | kFlags[draw.count(0, 3)]);
}

void setDamping(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  const auto one = [&] {
    return draw.chance(0.4) ? btScalar(0) : static_cast<btScalar>(draw.even(0.0, 1.0));
  };
  const btScalar linear = one();
  rigid.setDamping(linear, one());
}

void setActivation(GuestWorld& world, Draw& draw) {
  constexpr int kStates[] = {ACTIVE_TAG, ISLAND_SLEEPING, WANTS_DEACTIVATION, DISABLE_DEACTIVATION,
                             DISABLE_SIMULATION};
  GuestBody& body = world.drawDynamicBody(draw);
  btRigidBody& rigid = *body.rigid;
  const int state = kStates[draw.count(0, 4)];
  body.was_put_to_sleep |= state == ISLAND_SLEEPING;
  if (draw.chance(0.3)) {
    rigid.setActivationState(state);
  } else {
    rigid.forceActivationState(state);
  }
}

void wake(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  rigid.activate(draw.chance(0.5));
  if (draw.chance(0.5)) rigid.setDeactivationTime(btScalar(1.9));
}

void setSleeping(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = pick(world, draw);
  const auto linear = static_cast<btScalar>(draw.even(0.0, 2.0));
  rigid.setSleepingThresholds(linear, static_cast<btScalar>(draw.even(0.0, 2.0)));
}

void removeOrPutBack(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  body.is_in_world ? world.remove(body) : world.add(body);
}

void removeAndPutBack(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  world.remove(body);
  world.add(body);
}

void makeAnother(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const bool was_in_world = body.is_in_world;
  world.destroy(body);
  if (body.mass > 0.0) body.mass *= draw.log(0.5, 2.0);
  world.make(body);
  if (was_in_world) world.add(body);
}

}  // namespace

void appendMotionActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"teleport", true, teleport},
                           {"teleport of the centre of mass", true, teleportCentre},
                           {"proceed to a pose", true, proceed},
                           {"translate", true, translate},
                           {"motion state", false, useMotionState},
                           {"velocity", true, setVelocity},
                           {"velocity without waking", true, setVelocityAsleep},
                           {"huge velocity", true, setHugeVelocity},
                           {"interpolation velocity", true, setInterpolation},
                           {"impulse", true, giveImpulse},
                           {"force and torque", true, giveForce},
                           {"push velocity", true, givePush},
                           {"clear a body's forces", true, clearForces},
                           {"integrate and damp once", true, integrateOnce},
                           {"save kinematic state", true, saveKinematic},
                           {"gravity of a body", true, setGravity},
                           {"world gravity for a body or not", true, flipGravity},
                           {"gyroscopic flags", true, setGyroscopic},
                           {"damping", true, setDamping},
                           {"activation state", true, setActivation},
                           {"wake", true, wake},
                           {"sleeping thresholds", true, setSleeping}});
}

void appendPresenceActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"take out or put back", false, removeOrPutBack},
                           {"take out and put back", false, removeAndPutBack},
                           {"another body at the address", false, makeAnother}});
}

}  // namespace tandem::demos::bench
