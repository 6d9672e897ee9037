#include "surroundings/host_pairs.h"

#include <typeinfo>

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcherMt.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace tandem {
namespace {

/// Makes an object active for a moment: Bullet's dispatcher lets no two sleepers collide.
class AwakeForAMoment {
 public:
  explicit AwakeForAMoment(const btCollisionObject& object)
      : object_(object), state_(object.getActivationState()) {
    object_.forceActivationState(ACTIVE_TAG);
  }
  ~AwakeForAMoment() { object_.forceActivationState(state_); }
  AwakeForAMoment(const AwakeForAMoment&) = delete;
  AwakeForAMoment& operator=(const AwakeForAMoment&) = delete;

 private:
  const btCollisionObject& object_;
  int state_;
};

/// Bullet's own classes only ask what we ask, too.
bool hasOwnDispatcher(btDispatcher& dispatcher) {
  const std::type_info& type = typeid(dispatcher);
  return type != typeid(btCollisionDispatcher) && type != typeid(btCollisionDispatcherMt);
}

}  // namespace

bool hostLetsTouch(btDiscreteDynamicsWorld& host, const btCollisionObject& a,
                   const btCollisionObject& b) {
  auto* proxy_a = const_cast<btBroadphaseProxy*>(a.getBroadphaseHandle());
  auto* proxy_b = const_cast<btBroadphaseProxy*>(b.getBroadphaseHandle());
  if (proxy_a == nullptr || proxy_b == nullptr) return false;
  if (!host.getPairCache()->needsBroadphaseCollision(proxy_a, proxy_b) || !a.checkCollideWith(&b) ||
      !b.checkCollideWith(&a))
    return false;
  btDispatcher& dispatcher = *host.getDispatcher();
  if (!hasOwnDispatcher(dispatcher)) return true;
  const AwakeForAMoment awake(a);
  return dispatcher.needsCollision(&a, &b) && dispatcher.needsResponse(&a, &b);
}

bool mindsNoFilter(btDiscreteDynamicsWorld& host, const btCollisionObject& a,
                   const btCollisionObject& b) {
  btDispatcher& dispatcher = *host.getDispatcher();
  if (!hasOwnDispatcher(dispatcher)) return false;
  const AwakeForAMoment awake(a);
  return dispatcher.needsCollision(&a, &b);
}

bool hasOwnFilter(btDiscreteDynamicsWorld& host) {
  return host.getPairCache()->getOverlapFilterCallback() != nullptr ||
         hasOwnDispatcher(*host.getDispatcher());
}

bool hasOwnNearCallback(btDiscreteDynamicsWorld& host) {
  const auto* dispatcher = dynamic_cast<btCollisionDispatcher*>(host.getDispatcher());
  return dispatcher != nullptr &&
         dispatcher->getNearCallback() != &btCollisionDispatcher::defaultNearCallback;
}

}  // namespace tandem
