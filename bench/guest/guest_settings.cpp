#include <algorithm>
#include <string>
#include <vector>

#include "bench/guest/guest_differences.h"
#include "bench/guest/guest_site.h"
#include "bullet_bridge/src/bodies/equal_bits.h"

// Settings of bodies that a site must leave or restore, to the bit.

namespace tandem::demos::bench {
namespace {

/// Active and asleep are one: physics decides. Others are the host's.
int kindOfActivation(const btRigidBody& body) {
  const int state = body.getActivationState();
  return state == DISABLE_SIMULATION || state == DISABLE_DEACTIVATION ? state : ACTIVE_TAG;
}

/// Position of an object among a world's bodies; -1: the floor; -2: another one.
int indexOf(GuestWorld& world, const btCollisionObject* object) {
  for (std::size_t b = 0; b < world.bodies().size(); ++b)
    if (world.bodies()[b]->rigid == object) return static_cast<int>(b);
  return object == &world.floor() ? -1 : -2;
}

/// In rising order: Bullet only asks whether a body is among them.
std::vector<int> ignoredBy(GuestWorld& world, btRigidBody& body) {
  std::vector<int> ignored;
  for (int i = 0; i < body.getNumObjectsWithoutCollision(); ++i)
    ignored.push_back(indexOf(world, body.getObjectWithoutCollision(i)));
  std::sort(ignored.begin(), ignored.end());
  return ignored;
}

/// True if two weights differ by rounding at most.
bool isNear(const btVector3& a, const btVector3& b) {
  return (a - b).length() <= btScalar(2) * SIMD_EPSILON * a.length();
}

}  // namespace

std::string compareSettings(GuestWorld& world, GuestWorld& twin, std::size_t body) {
  const GuestBody& own = *world.bodies()[body];
  btRigidBody &a = *own.rigid, &b = *twin.bodies()[body]->rigid;
  Differences found;
  found.expect(a.getInvMass() == b.getInvMass(), "mass");
  found.expect(equalBits(a.getInvInertiaDiagLocal(), b.getInvInertiaDiagLocal()), "inertia");
  // Bullet tells sleeping bodies no gravity, and sleep is not compared. A site wakes those of its
  // own, but none that its host put to sleep.
  const bool has_all_gravity = !twin.bodies()[body]->missed_gravity && !own.has_unclear_gravity &&
                               !(own.missed_gravity && own.was_put_to_sleep);
  found.expect(!has_all_gravity || equalBits(a.getGravity(), b.getGravity()), "gravity");
  found.expect(a.getFlags() == b.getFlags(), "flags");
  found.expect(a.getCollisionFlags() == b.getCollisionFlags(), "collision_flags");
  found.expect(a.getLinearDamping() == b.getLinearDamping(), "linear_damping");
  found.expect(a.getAngularDamping() == b.getAngularDamping(), "angular_damping");
  found.expect(equalBits(a.getLinearFactor(), b.getLinearFactor()), "linear_factor");
  found.expect(equalBits(a.getAngularFactor(), b.getAngularFactor()), "angular_factor");
  found.expect(a.getLinearSleepingThreshold() == b.getLinearSleepingThreshold(),
               "sleeping_threshold");
  found.expect(a.getFriction() == b.getFriction(), "friction");
  found.expect(a.getRollingFriction() == b.getRollingFriction(), "rolling_friction");
  found.expect(a.getSpinningFriction() == b.getSpinningFriction(), "spinning_friction");
  found.expect(a.getRestitution() == b.getRestitution(), "restitution");
  found.expect(a.getContactStiffness() == b.getContactStiffness(), "contact_stiffness");
  found.expect(a.getContactProcessingThreshold() == b.getContactProcessingThreshold(), "threshold");
  found.expect(a.getCcdMotionThreshold() == b.getCcdMotionThreshold(), "ccd");
  found.expect(a.getUserIndex() == b.getUserIndex(), "user_index");
  found.expect(
      equalBits(a.getCollisionShape()->getLocalScaling(), b.getCollisionShape()->getLocalScaling()),
      "scaling");
  found.expect(a.getCollisionShape()->getMargin() == b.getCollisionShape()->getMargin(), "margin");
  found.expect(kindOfActivation(a) == kindOfActivation(b), "activation");
  found.expect(ignoredBy(world, a) == ignoredBy(twin, b), "ignored_pairs");
  found.expect(a.getNumConstraintRefs() == b.getNumConstraintRefs(), "joints");
  if (!world.hasWorld() || !own.is_in_world) return found.text();
  found.expect(a.getBroadphaseHandle()->m_collisionFilterGroup ==
                   b.getBroadphaseHandle()->m_collisionFilterGroup,
               "group");
  found.expect(a.getBroadphaseHandle()->m_collisionFilterMask ==
                   b.getBroadphaseHandle()->m_collisionFilterMask,
               "mask");
  // The weight that applyGravity() adds has the rounding of setMassProps().
  a.clearForces();
  b.clearForces();
  a.applyGravity();
  b.applyGravity();
  // Bullet rounds the weight of a body that is added another way, and adding leaves no trace.
  const bool is_same_weight = own.was_added_anew ? isNear(a.getTotalForce(), b.getTotalForce())
                                                 : equalBits(a.getTotalForce(), b.getTotalForce());
  found.expect(!has_all_gravity || is_same_weight, "weight");
  a.clearForces();
  b.clearForces();
  return found.text();
}

}  // namespace tandem::demos::bench
