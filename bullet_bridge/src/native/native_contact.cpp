#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "bodies/haptic_body.h"

namespace tandem {

void filterNativeContact(btDiscreteDynamicsWorld& world, btCollisionObject& keeper,
                         btCollisionObject& other, bool filtered) {
  // Bullet asks both, so one will do. It keeps one entry per call and takes one away per call, so
  // callers may overlap.
  keeper.setIgnoreCollisionCheck(&other, filtered);
  if (keeper.getBroadphaseHandle() == nullptr || other.getBroadphaseHandle() == nullptr) return;
  // A pair that is no longer checked keeps its last contact points for ever, and they go on
  // pushing.
  btBroadphasePair* pair =
      world.getPairCache()->findPair(keeper.getBroadphaseHandle(), other.getBroadphaseHandle());
  if (pair != nullptr) world.getPairCache()->cleanOverlappingPair(*pair, world.getDispatcher());
}

}  // namespace tandem
