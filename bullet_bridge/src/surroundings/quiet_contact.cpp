#include "surroundings/quiet_contact.h"

#include <new>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <LinearMath/btPoolAllocator.h>

namespace tandem {

btPersistentManifold* QuietDispatcher::getNewManifold(const btCollisionObject* a,
                                                      const btCollisionObject* b) {
  void* place = m_persistentManifoldPoolAllocator->allocate(sizeof(btPersistentManifold));
  if (place == nullptr) place = btAlignedAlloc(sizeof(btPersistentManifold), 16);
  return new (place) btPersistentManifold(a, b, 0, breaking_threshold_, breaking_threshold_);
}

void QuietDispatcher::releaseManifold(btPersistentManifold* manifold) {
  manifold->~btPersistentManifold();
  if (m_persistentManifoldPoolAllocator->validPtr(manifold)) {
    m_persistentManifoldPoolAllocator->freeMemory(manifold);
  } else {
    btAlignedFree(manifold);
  }
}

void QuietResult::addContactPoint(const btVector3& normal_on_b, const btVector3& large_point_on_b,
                                  btScalar large_depth) {
  const btVector3 point_on_b = large_point_on_b / scale_;
  const btScalar depth = large_depth / scale_;
  if (depth > kept_.getContactBreakingThreshold()) return;
  const bool is_swapped = kept_.getBody0() != getBody0Internal();
  const btCollisionObject& first = is_swapped ? *getBody1Internal() : *getBody0Internal();
  const btCollisionObject& second = is_swapped ? *getBody0Internal() : *getBody1Internal();
  const btVector3 point_on_a = point_on_b + normal_on_b * depth;
  btManifoldPoint point(first.getWorldTransform().invXform(point_on_a),
                        second.getWorldTransform().invXform(point_on_b), normal_on_b, depth);
  point.m_positionWorldOnA = point_on_a;
  point.m_positionWorldOnB = point_on_b;
  const int known = kept_.getCacheEntry(point);
  if (known >= 0) {
    kept_.replaceContactPoint(point, known);
  } else {
    kept_.addManifoldPoint(point);
  }
  if (shows_kept_) setPersistentManifold(&kept_);
}

void refreshQuietly(btPersistentManifold& manifold) noexcept {
  const btTransform& pose_a = manifold.getBody0()->getWorldTransform();
  const btTransform& pose_b = manifold.getBody1()->getWorldTransform();
  const btScalar most = manifold.getContactBreakingThreshold();
  for (int i = manifold.getNumContacts() - 1; i >= 0; --i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    point.m_positionWorldOnA = pose_a(point.m_localPointA);
    point.m_positionWorldOnB = pose_b(point.m_localPointB);
    point.m_distance1 =
        (point.m_positionWorldOnA - point.m_positionWorldOnB).dot(point.m_normalWorldOnB);
    const btVector3 projected =
        point.m_positionWorldOnA - point.m_normalWorldOnB * point.m_distance1;
    const btVector3 aside = point.m_positionWorldOnB - projected;
    if (manifold.validContactDistance(point) && aside.dot(aside) <= most * most) continue;
    const int last = manifold.getNumContacts() - 1;
    if (i != last) point = manifold.getContactPoint(last);
    manifold.setNumContacts(last);
  }
}

}  // namespace tandem
