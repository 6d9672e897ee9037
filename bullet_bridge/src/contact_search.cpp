#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include "contact_solver.h"

namespace tandem {
namespace {

constexpr btScalar kMaxPushSpeed = btScalar(0.25);  // [m/s] overlap leaves at most as fast as this

}  // namespace

void ContactSolver::findContacts(std::size_t slot) {
  Body& body = bodies_[slot];
  const btCollisionShape& shape = *body.copy->getCollisionShape();
  const btScalar skin = shape.getContactBreakingThreshold(gContactBreakingThreshold);
  const Region region = growRegion(computeRegion(shape, body.given_pose), skin);
  for (const auto& obstacle : obstacles_) {
    btCollisionAlgorithm*& algorithm = obstacle->algorithms[slot];
    if (obstacle->meets[slot] &&
        mayReach(*obstacle->object.getCollisionShape(), obstacle->object.getWorldTransform(),
                 obstacle->bounds, region)) {
      updateContact(body, algorithm, *obstacle);
    } else {
      release(algorithm);
    }
  }
}

void ContactSolver::updateContact(Body& body, btCollisionAlgorithm*& algorithm,
                                  ObstacleCopy& obstacle) {
  const btCollisionObjectWrapper moving(nullptr, body.copy->getCollisionShape(), body.copy.get(),
                                        body.copy->getWorldTransform(), -1, -1);
  const btCollisionObjectWrapper fixed(nullptr, obstacle.object.getCollisionShape(),
                                       &obstacle.object, obstacle.object.getWorldTransform(), -1,
                                       -1);
  if (algorithm == nullptr)
    algorithm = dispatcher_.findAlgorithm(&moving, &fixed, nullptr, BT_CONTACT_POINT_ALGORITHMS);
  if (algorithm == nullptr) return;
  if (obstacle.plane) slideAlong(*algorithm, body, obstacle);
  btManifoldResult result(&moving, &fixed);
  algorithm->processCollision(&moving, &fixed, dispatch_, &result);
  algorithm->getAllContactManifolds(manifolds_);
}

/// Bullet drops a contact whose two points have drifted apart along the surface, and for a step the
/// body stands on fewer corners. A plane is the same everywhere: there the obstacle's point follows
/// the body's.
void ContactSolver::slideAlong(btCollisionAlgorithm& algorithm, const Body& body,
                               const ObstacleCopy& obstacle) {
  sliding_.resize(0);
  algorithm.getAllContactManifolds(sliding_);
  for (int m = 0; m < sliding_.size(); ++m) {
    btPersistentManifold& manifold = *sliding_[m];
    const bool is_first = manifold.getBody0() == body.copy.get();
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      btManifoldPoint& point = manifold.getContactPoint(i);
      btVector3& on_obstacle = is_first ? point.m_localPointB : point.m_localPointA;
      const btVector3 on_body =
          body.given_pose * (is_first ? point.m_localPointA : point.m_localPointB);
      const btTransform& pose = obstacle.object.getWorldTransform();
      const btVector3 normal = pose.getBasis() * obstacle.plane->getPlaneNormal();
      on_obstacle = pose.invXform(on_body - normal * normal.dot(on_body - pose.getOrigin()));
    }
  }
}

void ContactSolver::release(btCollisionAlgorithm*& algorithm) {
  if (algorithm == nullptr) return;
  algorithm->~btCollisionAlgorithm();
  dispatcher_.freeCollisionAlgorithm(algorithm);
  algorithm = nullptr;
}

void ContactSolver::removeAlgorithms(ObstacleCopy& obstacle) {
  for (btCollisionAlgorithm*& algorithm : obstacle.algorithms) release(algorithm);
}

void ContactSolver::moveContactsToStart(btPersistentManifold& manifold, const Body& body,
                                        btScalar dt) const {
  const bool is_first = manifold.getBody0() == body.copy.get();
  if (!is_first && manifold.getBody1() != body.copy.get()) return;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    btManifoldPoint& point = manifold.getContactPoint(i);
    const btVector3& place = is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
    const btVector3 v = body.copy->getVelocityInLocalPoint(place - body.given_pose.getOrigin());
    // The normal points from the second object to the first.
    const btScalar opening =
        point.m_normalWorldOnB.dot(v) * (is_first ? btScalar(1) : btScalar(-1));
    btScalar distance = point.getDistance() - opening * dt;
    // A bounce happens at the surface; left with a gap to close, it would lose speed to it.
    const bool bounces =
        point.m_combinedRestitution > 0 && opening < -settings_.m_restitutionVelocityThreshold;
    if (bounces) distance = btMin(distance, btScalar(0));
    point.setDistance(btMax(distance, -kMaxPushSpeed * dt / settings_.m_erp2));
  }
}

}  // namespace tandem
