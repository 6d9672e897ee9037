#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace tandem::bench {

/// Boxes of 4 cm that stand in a square on a plane, far below the scene, and never sleep. They are
/// the other load of a host's world.
class Crowd {
 public:
  /// The world must outlive this.
  Crowd(btDiscreteDynamicsWorld& world, int count);
  ~Crowd();
  Crowd(const Crowd&) = delete;
  Crowd& operator=(const Crowd&) = delete;

 private:
  btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& p_W);

  btDiscreteDynamicsWorld& world_;
  btStaticPlaneShape floor_shape_;
  btBoxShape box_shape_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

/// A host's world with a crowd and without Tandem.
class BareHost {
 public:
  explicit BareHost(int boxes) : crowd_(world_, boxes) {}
  [[nodiscard]] btDiscreteDynamicsWorld& world() noexcept { return world_; }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  Crowd crowd_;
};

}  // namespace tandem::bench
