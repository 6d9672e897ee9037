#include <cstddef>
#include <string>

#include "bench/guest/guest_arm.h"
#include "bench/guest/guest_differences.h"
#include "bullet_bridge/src/bodies/equal_bits.h"

// Settings of arms that a site must leave or restore, to the bit.

namespace tandem::demos::bench {
namespace {

void compareBodies(const btMultiBody& a, const btMultiBody& b, Differences& found) {
  found.expect(a.getMaxCoordinateVelocity() == b.getMaxCoordinateVelocity(), "most_velocity");
  found.expect(a.getMaxAppliedImpulse() == b.getMaxAppliedImpulse(), "most_impulse");
  found.expect(a.getBaseMass() == b.getBaseMass(), "base_mass");
  found.expect(equalBits(a.getBaseInertia(), b.getBaseInertia()), "base_inertia");
  found.expect(a.getLinearDamping() == b.getLinearDamping(), "linear_damping");
  found.expect(a.getAngularDamping() == b.getAngularDamping(), "angular_damping");
  found.expect(a.getCanSleep() == b.getCanSleep(), "can_sleep");
  found.expect(a.getCanWakeup() == b.getCanWakeup(), "can_wake");
  found.expect(a.getUseGyroTerm() == b.getUseGyroTerm(), "gyro_term");
  found.expect(a.hasSelfCollision() == b.hasSelfCollision(), "self_collision");
  for (int i = 0; i < a.getNumLinks(); ++i) {
    const btMultibodyLink &link = a.getLink(i), &other = b.getLink(i);
    found.expect(link.m_mass == other.m_mass, "link_mass");
    found.expect(equalBits(link.m_inertiaLocal, other.m_inertiaLocal), "link_inertia");
    found.expect(link.m_flags == other.m_flags, "link_flags");
  }
}

/// Filters are compared while both are in a world.
void compareColliders(const btCollisionObject& a, const btCollisionObject& b, Differences& found) {
  found.expect(a.getCollisionFlags() == b.getCollisionFlags(), "collision_flags");
  found.expect(a.getNumObjectsWithoutCollision() == b.getNumObjectsWithoutCollision(),
               "ignored_pairs");
  found.expect(a.getFriction() == b.getFriction(), "friction");
  found.expect(a.getRestitution() == b.getRestitution(), "restitution");
  const btBroadphaseProxy *own = a.getBroadphaseHandle(), *other = b.getBroadphaseHandle();
  if (!own || !other) return;
  found.expect(own->m_collisionFilterGroup == other->m_collisionFilterGroup, "group");
  found.expect(own->m_collisionFilterMask == other->m_collisionFilterMask, "mask");
}

}  // namespace

std::string compareArms(const GuestArm& arm, const GuestArm& twin) {
  Differences found;
  compareBodies(arm.body(), twin.body(), found);
  for (std::size_t c = 0; c < arm.colliders().size(); ++c)
    compareColliders(*arm.colliders()[c], *twin.colliders()[c], found);
  found.expect(arm.holds().size() == twin.holds().size(), "number_of_holds");
  if (arm.holds().size() != twin.holds().size()) return found.text();
  for (std::size_t h = 0; h < arm.holds().size(); ++h)
    found.expect(arm.holds()[h].constraint->getMaxAppliedImpulse() ==
                     twin.holds()[h].constraint->getMaxAppliedImpulse(),
                 "most_impulse_of_hold");
  return found.text();
}

}  // namespace tandem::demos::bench
