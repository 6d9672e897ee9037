#pragma once

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <btBulletDynamicsCommon.h>

namespace tandem::test {

struct Parts {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase pairs;
  btSequentialImpulseConstraintSolver solver;
  btMultiBodyConstraintSolver solver_of_derived;
};

/// 40 mm cubes of 0.2 kg on a floor; the first stands alone.
class Scene {
 public:
  explicit Scene(btDiscreteDynamicsWorld& world) : world_(world) {
    world_.setGravity(btVector3(0, 0, btScalar(-9.81)));
    add(ground_, btVector3(0, 0, 0), 0);
  }
  ~Scene() {
    if (!is_world_gone_)
      for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  void addCubes() {
    for (int i = 0; i < 3; ++i)
      add(cube_, btVector3(btScalar(0.15 * i), 0, btScalar(0.02 + 0.01 * i)), btScalar(0.2));
  }
  void forgetWorld() { is_world_gone_ = true; }
  void removeFirstCube() { world_.removeRigidBody(bodies_[1].get()); }
  void putFirstCubeBack() { world_.addRigidBody(bodies_[1].get()); }
  [[nodiscard]] btRigidBody& firstCube() const { return *bodies_[1]; }

  void hash(std::uint64_t& state) const {
    for (const auto& body : bodies_) {
      const btTransform& pose = body->getWorldTransform();
      const btVector3* values[] = {&pose.getOrigin(), &pose.getBasis()[0], &pose.getBasis()[1],
                                   &body->getLinearVelocity(), &body->getAngularVelocity()};
      for (const btVector3* value : values) {
        unsigned char bytes[3 * sizeof(btScalar)];
        std::memcpy(bytes, value->m_floats, sizeof bytes);
        for (const unsigned char byte : bytes) state = (state ^ byte) * 0x100000001b3u;
      }
    }
  }

 private:
  void add(btCollisionShape& shape, const btVector3& at, btScalar mass) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform.setOrigin(at);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    world_.addRigidBody(bodies_.back().get());
  }

  btDiscreteDynamicsWorld& world_;
  btStaticPlaneShape ground_{btVector3(0, 0, 1), 0};
  btBoxShape cube_{btVector3(btScalar(0.02), btScalar(0.02), btScalar(0.02))};
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  bool is_world_gone_ = false;
};

/// Prints the result of a host's run in one line.
inline void print(std::uint64_t hash, const btRigidBody& cube) {
  const btVector3& p = cube.getCenterOfMassPosition();
  std::printf("hash %016llx cube %.6f %.6f %.6f mass %.6f\n", static_cast<unsigned long long>(hash),
              static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z()),
              1.0 / static_cast<double>(cube.getInvMass()));
}

}  // namespace tandem::test
