#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "tandem/bullet_bridge/haptic_body.h"

namespace tandem {

void filterNativeContact(btDiscreteDynamicsWorld& world, btCollisionObject& a, btCollisionObject& b,
                         bool filtered) {
  // Bullet keeps one entry per call and takes one away per call, so callers may overlap.
  a.setIgnoreCollisionCheck(&b, filtered);
  b.setIgnoreCollisionCheck(&a, filtered);
  if (a.getBroadphaseHandle() == nullptr || b.getBroadphaseHandle() == nullptr) return;
  // A pair that is no longer checked keeps its last contact points for ever, and they go on
  // pushing.
  btBroadphasePair* pair =
      world.getPairCache()->findPair(a.getBroadphaseHandle(), b.getBroadphaseHandle());
  if (pair != nullptr) world.getPairCache()->cleanOverlappingPair(*pair, world.getDispatcher());
}

}  // namespace tandem
