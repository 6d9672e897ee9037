#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_acts.h"
#include "bench/guest/guest_world.h"

// Mass, shape, surface and participation of bodies.

namespace tandem::demos::bench {
namespace {

btScalar drawScalar(Draw& draw, double low, double high) {
  return static_cast<btScalar>(draw.even(low, high));
}

btVector3 drawVector(Draw& draw, double low, double high) {
  const btScalar x = drawScalar(draw, low, high), y = drawScalar(draw, low, high);
  return {x, y, drawScalar(draw, low, high)};
}

void flipFlag(btRigidBody& rigid, int flag) {
  rigid.setCollisionFlags(rigid.getCollisionFlags() ^ flag);
}

void scaleMass(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  body.mass *= draw.log(0.2, 5.0);
  if (body.rigid->getInvMass() > 0) world.setMass(body, body.mass);
}

void pinByReadding(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  world.remove(body);
  world.noteGravityOf(body);
  world.setMass(body, body.rigid->getInvMass() > 0 ? 0.0 : body.mass);
  world.add(body);
}

void pinInPlace(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  world.setMass(body, body.rigid->getInvMass() > 0 ? 0.0 : body.mass);
}

void changeInertia(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  const double factor = draw.log(0.3, 3.0);
  if (!(body.rigid->getInvMass() > 0)) return;
  btVector3 inertia;
  body.shape->calculateLocalInertia(static_cast<btScalar>(factor * body.mass), inertia);
  body.rigid->setInvInertiaDiagLocal(btVector3(1, 1, 1) / inertia);
  body.rigid->updateInertiaTensor();
}

void scaleShape(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const btScalar factor = drawScalar(draw, 0.7, 1.3);
  body.shape->setLocalScaling(btVector3(factor, factor, factor));
  if (body.is_in_world) world.world().updateSingleAabb(body.rigid);
}

void changeMargin(GuestWorld& world, Draw& draw) {
  world.drawBody(draw).shape->setMargin(drawScalar(draw, 0.0, 0.01));
}

void swapShape(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  const auto kind = static_cast<GuestShape>(draw.count(0, kGuestShapeCount - 1));
  btCollisionShape& shape = world.makeShape(kind, body.plan.size * draw.even(0.8, 1.1), 3);
  if (draw.chance(0.5)) {
    world.renewPairs(body);
    world.setShape(body, shape);
  } else {
    const bool was_in_world = body.is_in_world;
    world.remove(body);
    world.setShape(body, shape);
    if (was_in_world) world.add(body);
  }
}

void moveChild(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const btVector3 at = drawVector(draw, -0.01, 0.01);
  if (!body.shape->isCompound()) return;
  auto& compound = static_cast<btCompoundShape&>(*body.shape);
  if (compound.getNumChildShapes() < 2) return;
  btTransform child = compound.getChildTransform(1);
  child.setOrigin(at);
  compound.updateChildTransform(1, child);
}

void scaleChild(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const btScalar factor = drawScalar(draw, 0.8, 1.2);
  if (!body.shape->isCompound()) return;
  auto& compound = static_cast<btCompoundShape&>(*body.shape);
  compound.getChildShape(0)->setLocalScaling(btVector3(factor, factor, factor));
  compound.recalculateLocalAabb();
}

void changeFriction(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = *world.drawBody(draw).rigid;
  rigid.setFriction(drawScalar(draw, 0.0, 1.5));
  rigid.setRollingFriction(draw.chance(0.5) ? btScalar(0) : drawScalar(draw, 0.0, 0.1));
  rigid.setSpinningFriction(draw.chance(0.5) ? btScalar(0) : drawScalar(draw, 0.0, 0.1));
}

void changeRestitution(GuestWorld& world, Draw& draw) {
  world.drawBody(draw).rigid->setRestitution(drawScalar(draw, 0.0, 1.0));
}

void changeAnisotropy(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = *world.drawBody(draw).rigid;
  constexpr int kModes[] = {btCollisionObject::CF_ANISOTROPIC_FRICTION_DISABLED,
                            btCollisionObject::CF_ANISOTROPIC_FRICTION,
                            btCollisionObject::CF_ANISOTROPIC_ROLLING_FRICTION};
  const btVector3 factors = drawVector(draw, 0.0, 1.0);
  rigid.setAnisotropicFriction(factors, kModes[draw.count(0, 2)]);
}

void changeContactStiffness(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = *world.drawBody(draw).rigid;
  const auto stiffness = static_cast<btScalar>(draw.log(1e3, 1e6));
  if (draw.chance(0.5)) {
    rigid.setContactStiffnessAndDamping(stiffness, drawScalar(draw, 0.0, 10.0));
  } else {
    rigid.setCollisionFlags(rigid.getCollisionFlags() &
                            ~btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING);
  }
}

void changeThreshold(GuestWorld& world, Draw& draw) {
  world.drawBody(draw).rigid->setContactProcessingThreshold(drawScalar(draw, 0.001, 0.02));
}

void changeCcd(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const auto size = static_cast<btScalar>(body.plan.size);
  body.rigid->setCcdMotionThreshold(draw.chance(0.3) ? btScalar(0) : size / 2);
  body.rigid->setCcdSweptSphereRadius(size / 2);
}

void flipKinematic(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawDynamicBody(draw);
  world.removeTiesOf(body);
  flipFlag(*body.rigid, btCollisionObject::CF_KINEMATIC_OBJECT);
}

void flipResponse(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  flipFlag(*body.rigid, btCollisionObject::CF_NO_CONTACT_RESPONSE);
  // Others may stand on it.
  for (const auto& each : world.bodies()) each->may_fall |= body.mass == 0.0;
  body.may_fall = true;
}

void flipQuietFlag(GuestWorld& world, Draw& draw) {
  constexpr int kFlags[] = {btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK,
                            btCollisionObject::CF_CHARACTER_OBJECT,
                            btCollisionObject::CF_DISABLE_VISUALIZE_OBJECT,
                            btCollisionObject::CF_DISABLE_SPU_COLLISION_PROCESSING,
                            btCollisionObject::CF_HAS_FRICTION_ANCHOR};
  btRigidBody& rigid = *world.drawBody(draw).rigid;
  flipFlag(rigid, kFlags[draw.count(0, 4)]);
}

void changeGroup(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const bool was_in_world = body.is_in_world;
  world.remove(body);
  body.has_filter = true;
  body.group = 1 << draw.count(0, 6);
  body.mask = draw.chance(0.5) ? -1 : draw.count(0, 127);
  if (was_in_world) world.add(body);
  for (const auto& each : world.bodies()) each->may_fall |= body.mass == 0.0;
  body.may_fall = true;
}

void changeGroupInPlace(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  const int mask = draw.chance(0.5) ? -1 : draw.count(0, 127);
  if (!body.is_in_world) return;
  body.rigid->getBroadphaseHandle()->m_collisionFilterMask = mask;
  world.world().refreshBroadphaseProxy(body.rigid);
  for (const auto& each : world.bodies()) each->may_fall |= body.mass == 0.0;
  body.may_fall = true;
}

void ignorePair(GuestWorld& world, Draw& draw) {
  GuestBody &a = world.drawBody(draw), &b = world.drawBody(draw);
  const bool ignores = draw.chance(0.7);
  const bool is_floor = draw.chance(0.2);
  btRigidBody& other = is_floor ? world.floor() : *b.rigid;
  if (&a == &b && !is_floor) return;
  a.rigid->setIgnoreCollisionCheck(&other, ignores);
  world.renewPairs(a);
  a.may_fall = b.may_fall = true;
}

void changeLinearFactor(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = *world.drawDynamicBody(draw).rigid;
  const auto pick = [&] { return static_cast<btScalar>(draw.count(0, 1)); };
  const btScalar x = pick(), y = pick();
  rigid.setLinearFactor(draw.chance(0.4) ? btVector3(1, 1, 1) : btVector3(x, y, 1));
}

void changeAngularFactor(GuestWorld& world, Draw& draw) {
  btRigidBody& rigid = *world.drawDynamicBody(draw).rigid;
  const auto pick = [&] { return static_cast<btScalar>(draw.count(0, 2)) / 2; };
  const btScalar x = pick(), y = pick(), z = pick();
  rigid.setAngularFactor(draw.chance(0.4) ? btVector3(1, 1, 1) : btVector3(x, y, z));
}

void changeUserData(GuestWorld& world, Draw& draw) {
  GuestBody& body = world.drawBody(draw);
  body.rigid->setUserPointer(&body);
  body.rigid->setUserIndex(draw.count(0, 9));
  body.rigid->setUserIndex2(draw.count(0, 9));
  body.rigid->setUserIndex3(draw.count(0, 9));
  body.rigid->setCustomDebugColor(btVector3(1, 0, 0));
}

}  // namespace

void appendMassActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"mass", true, scaleMass},
                           {"pin or free, taken out meanwhile", false, pinByReadding},
                           {"pin or free in place", true, pinInPlace},
                           {"inertia", true, changeInertia},
                           {"scaling of a shape", true, scaleShape},
                           {"margin", true, changeMargin},
                           {"another shape", false, swapShape},
                           {"move a child of a compound", true, moveChild},
                           {"scale a child of a compound", true, scaleChild},
                           {"linear factor", true, changeLinearFactor},
                           {"angular factor", true, changeAngularFactor}});
}

void appendSurfaceActs(std::vector<GuestAct>& acts) {
  acts.insert(acts.end(), {{"friction, rolling, spinning", true, changeFriction},
                           {"restitution", true, changeRestitution},
                           {"anisotropic friction", true, changeAnisotropy},
                           {"contact stiffness and damping", true, changeContactStiffness},
                           {"contact processing threshold", true, changeThreshold},
                           {"continuous collision detection", true, changeCcd},
                           {"kinematic on or off", true, flipKinematic},
                           {"contact response on or off", true, flipResponse},
                           {"a flag of no consequence", true, flipQuietFlag},
                           {"group and mask", false, changeGroup},
                           {"mask in place", false, changeGroupInPlace},
                           {"ignore a pair or not", false, ignorePair},
                           {"user data", true, changeUserData}});
}

}  // namespace tandem::demos::bench
