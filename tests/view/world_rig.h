#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "bullet_values.h"

namespace tandem::test {

/// A world of Bullet with a few bodies, which it owns. Shapes belong to the test.
class WorldRig {
 public:
  WorldRig() { world.setGravity(vec(0, 0, -9.81)); }
  ~WorldRig() {
    for (const auto& body : bodies_) world.removeRigidBody(body.get());
  }
  WorldRig(const WorldRig&) = delete;
  WorldRig& operator=(const WorldRig&) = delete;

  /// A body of `mass` [kg] at p [m]; without a mass it is static.
  btRigidBody& add(btCollisionShape& shape, btScalar mass, const btVector3& p) {
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, btVector3(1, 1, 1));
    info.m_startWorldTransform.setOrigin(p);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies_.back().get());
    return *bodies_.back();
  }
  void remove(const btRigidBody& body) {
    const auto at = std::find_if(bodies_.begin(), bodies_.end(),
                                 [&](const auto& owned) { return owned.get() == &body; });
    world.removeRigidBody(at->get());
    bodies_.erase(at);
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;

 public:
  btDiscreteDynamicsWorld world{&dispatcher_, &broadphase_, &solver_, &configuration_};

 private:
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace tandem::test
