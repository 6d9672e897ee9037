#include "arms/arm_watch.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "arms/arm_constraint.h"
#include "arms/arm_model.h"
#include "bodies/equal_bits.h"
#include "world/world_lookup.h"

namespace tandem {
namespace {

const btCollisionObject* colliderOf(const btMultiBody& body, int link) {
  return link < 0 ? body.getBaseCollider() : body.getLinkCollider(link);
}

/// True if link (-1: the base) moves with the world: the base is fixed, and so are all joints.
bool isLinkGround(const btMultiBody& body, int link) {
  if (!body.hasFixedBase()) return false;
  for (; link >= 0; link = body.getParent(link))
    if (body.getLink(link).m_jointType != btMultibodyLink::eFixed) return false;
  return true;
}

const char* findLinkObstacle(const btMultiBody& body, int link) {
  if (isLinkGround(body, link)) return nullptr;
  const bool is_base = link < 0;
  const btScalar mass = is_base ? body.getBaseMass() : body.getLinkMass(link);
  const btVector3& inertia = is_base ? body.getBaseInertia() : body.getLinkInertia(link);
  const bool is_fixed = !is_base && body.getLink(link).m_jointType == btMultibodyLink::eFixed;
  const btCollisionObject* collider = colliderOf(body, link);
  if (!is_base && body.getLink(link).m_jointType > btMultibodyLink::eFixed)
    return "a joint is of no known type";
  const bool is_frame = is_fixed && !collider && inertia.isZero();
  if (!(mass > 0)) return is_frame ? nullptr : "a link that moves has no mass";
  if (!(inertia.x() > 0 && inertia.y() > 0 && inertia.z() > 0))
    return "a link that moves has no inertia about some axis";
  if (!collider) return nullptr;
  if (collider->isStaticOrKinematicObject()) return "a link is static or kinematic";
  if (!hasPlainShape(*collider)) return "a link has a concave shape";
  if (!hasPlainSurface(*collider))
    return "a link has anisotropic friction or contact stiffness of its own";
  return nullptr;
}

}  // namespace

btMultiBodyDynamicsWorld* asMultiBodyWorld(btDiscreteDynamicsWorld& world) noexcept {
  return dynamic_cast<btMultiBodyDynamicsWorld*>(&world);
}

btMultiBody* multiBodyOf(const btCollisionObject& object) noexcept {
  if (object.getInternalType() != btCollisionObject::CO_FEATHERSTONE_LINK) return nullptr;
  return static_cast<const btMultiBodyLinkCollider&>(object).m_multiBody;
}

bool isGround(const btCollisionObject& object) noexcept {
  const btMultiBody* body = multiBodyOf(object);
  if (body == nullptr || object.isKinematicObject()) return false;
  return isLinkGround(*body, static_cast<const btMultiBodyLinkCollider&>(object).m_link);
}

bool isGround(const btMultiBody& body, int link) noexcept {
  const btCollisionObject* collider = colliderOf(body, link);
  const bool is_driven = body.isBaseKinematic() || (collider && collider->isKinematicObject());
  return !is_driven && isLinkGround(body, link);
}

bool hasMultiBody(btDiscreteDynamicsWorld& world, const btMultiBody* body) noexcept {
  const btMultiBodyDynamicsWorld* multi = asMultiBodyWorld(world);
  bool is_there = false;
  for (int i = 0; multi && i < multi->getNumMultibodies() && !is_there; ++i)
    is_there = multi->getMultiBody(i) == body;
  if (!is_there) return false;
  for (int link = -1; link < body->getNumLinks(); ++link) {
    const btCollisionObject* collider = colliderOf(*body, link);
    if (collider && findInWorld(world, collider, collider->getWorldArrayIndex()) < 0) return false;
  }
  return true;
}

const char* findObstacleToHold(btMultiBodyDynamicsWorld& world, btMultiBody& body) noexcept {
  if (body.isBaseKinematic()) return "its base is kinematic";
  if (body.isUsingRK4Integration() || body.isUsingGlobalVelocities())
    return "it uses another integration than Bullet's usual one";
  if (!body.getUseGyroTerm()) return "its gyroscopic term is off";
  for (int link = -1; link < body.getNumLinks(); ++link)
    if (const char* why = findLinkObstacle(body, link)) return why;
  for (int i = 0; i < world.getNumMultiBodyConstraints(); ++i) {
    btMultiBodyConstraint& constraint = *world.getMultiBodyConstraint(i);
    if (constraint.getMultiBodyA() != &body && constraint.getMultiBodyB() != &body) continue;
    if (const char* why = findObstacleToHold(constraint)) return why;
  }
  return nullptr;
}

ArmLook::ArmLook(const btMultiBody& body) : is_fixed_(body.hasFixedBase()) {
  for (int link = -1; link < body.getNumLinks(); ++link) links_.push_back(look(body, link));
}

ArmLook::Link ArmLook::look(const btMultiBody& body, int link) noexcept {
  Link now;
  now.mass = link < 0 ? body.getBaseMass() : body.getLinkMass(link);
  now.inertia = link < 0 ? body.getBaseInertia() : body.getLinkInertia(link);
  now.collider = colliderOf(body, link);
  if (now.collider) now.look = ColliderLook::at(*now.collider);
  return now;
}

bool ArmLook::isOf(const btMultiBody& body) const noexcept {
  if (links_.size() != static_cast<std::size_t>(body.getNumLinks()) + 1) return false;
  if (is_fixed_ != body.hasFixedBase()) return false;
  for (std::size_t place = 0; place < links_.size(); ++place) {
    const Link &known = links_[place], now = look(body, static_cast<int>(place) - 1);
    const bool is_same = known.collider == now.collider && known.look == now.look &&
                         known.mass == now.mass && equalBits(known.inertia, now.inertia);
    if (!is_same) return false;
  }
  return true;
}

}  // namespace tandem
