#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/ConstraintSolver/btContactSolverInfo.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>

#include "private_copies.h"

namespace tandem {

/// Bullet's narrowphase and contact solver on private copies: a few bodies against a few obstacles,
/// at the island's inner step. Bodies do not meet each other.
class ContactSolver {
 public:
  /// Restitution acts from this approach speed on [m/s], as in the host's world.
  explicit ContactSolver(btScalar restitution_threshold);
  ~ContactSolver();
  ContactSolver(const ContactSolver&) = delete;
  ContactSolver& operator=(const ContactSolver&) = delete;

  /// Set-up. Returns the body's slot. Takes all obstacles away, which know the bodies by slot.
  std::size_t addBody(const btRigidBody& original);

  [[nodiscard]] const Vec3& origin() const noexcept { return origin_W_; }
  void setOrigin(const Vec3& origin_W) { origin_W_ = origin_W; }

  /// The copies; to be placed again after a change of origin.
  [[nodiscard]] const std::vector<std::unique_ptr<ObstacleCopy>>& obstacles() const {
    return obstacles_;
  }
  /// `meets` by slot: which bodies the host lets touch it.
  ObstacleCopy& addObstacle(btCollisionObject& original, std::vector<bool> meets);
  void removeObstacle(const btCollisionObject* original);

  [[nodiscard]] bool isNear(std::size_t slot, const RigidState& state, double reach) const noexcept;
  void predict(std::size_t slot, const RigidState& before, const RigidState& after) noexcept;
  void solve(double dt) noexcept;
  bool correct(std::size_t slot, RigidState& after) const noexcept;

 private:
  struct Body {
    std::unique_ptr<btRigidBody> copy;
    RigidState before, after;  // as announced
    bool predicted = false;
    bool touched = false;  // in the last solve
    // What the copy was given; what Bullet changed is the difference.
    btTransform given_pose = btTransform::getIdentity();
    btVector3 given_v = btVector3(0, 0, 0), given_w = btVector3(0, 0, 0);
    // Velocity by contact, and shift and turn out of overlap.
    Vec3 dv_W = Vec3::Zero(), dw_W = Vec3::Zero(), push_W = Vec3::Zero();
    Quat turn_W = Quat::Identity();
  };

  [[nodiscard]] btTransform toPrivate(const RigidState& state) const;
  void placeAtEnd(Body& body, double dt);
  void findContacts(std::size_t slot);
  void updateContact(Body& body, btCollisionAlgorithm*& algorithm, ObstacleCopy& obstacle);
  void slideAlong(btCollisionAlgorithm& algorithm, const Body& body, const ObstacleCopy& obstacle);
  void release(btCollisionAlgorithm*& algorithm);
  void removeAlgorithms(ObstacleCopy& obstacle);
  void moveContactsToStart(btPersistentManifold& manifold, const Body& body, btScalar dt) const;
  void readBack(Body& body) const;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btSequentialImpulseConstraintSolver solver_;
  btDispatcherInfo dispatch_;
  btContactSolverInfo settings_;
  Vec3 origin_W_ = Vec3::Zero();
  std::vector<Body> bodies_;
  std::vector<std::unique_ptr<ObstacleCopy>> obstacles_;
  // Work space of solve().
  btAlignedObjectArray<btCollisionObject*> moving_;
  btManifoldArray manifolds_, sliding_;
  double step_ = 0.0;
};

}  // namespace tandem
