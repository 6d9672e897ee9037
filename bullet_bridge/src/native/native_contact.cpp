#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "bodies/haptic_body.h"

namespace tandem {

void filterNativeContact(btDiscreteDynamicsWorld& world, btCollisionObject& keeper,
                         btCollisionObject& other, bool filtered) {
  // Bullet checks both objects, so one entry is enough. Each call adds or removes one entry, so
  // callers may overlap.
  keeper.setIgnoreCollisionCheck(&other, filtered);
  if (keeper.getBroadphaseHandle() == nullptr || other.getBroadphaseHandle() == nullptr) return;
  // A pair that is no longer checked keeps its last contact points forever, and they keep pushing.
  btBroadphasePair* pair =
      world.getPairCache()->findPair(keeper.getBroadphaseHandle(), other.getBroadphaseHandle());
  if (pair != nullptr) world.getPairCache()->cleanOverlappingPair(*pair, world.getDispatcher());
}

}  // namespace tandem
