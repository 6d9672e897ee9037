#pragma once

#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "tandem/bullet_bridge/convert.h"
#include "tandem/coordination/types.h"

#include "bullet_bridge/src/world/host_world.h"

namespace tandem::test {

/// Picks the expectation for Bullet's width; the tests run against both.
[[nodiscard]] constexpr double byWidth(double if_double, double if_float) {
  return sizeof(btScalar) == sizeof(double) ? if_double : if_float;
}

/// Unit rotation about `axis`, for poses of test scenes.
[[nodiscard]] inline Quat turn(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

/// A host's world and the objects that it owns.
struct BulletRig {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btRigidBody>> bodies;

  explicit BulletRig(const Vec3& gravity = Vec3::Zero()) { world.setGravity(toBullet(gravity)); }
  ~BulletRig() {
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
  BulletRig(const BulletRig&) = delete;
  BulletRig& operator=(const BulletRig&) = delete;

  template <typename ShapeType, typename... Arguments>
  ShapeType& makeShape(Arguments&&... arguments) {
    auto shape = std::make_unique<ShapeType>(std::forward<Arguments>(arguments)...);
    ShapeType& reference = *shape;
    shapes.push_back(std::move(shape));
    return reference;
  }

  /// Adds a body; mass 0 makes it static.
  btRigidBody& addBody(btCollisionShape& shape, double mass, const Vec3& p_W = Vec3::Zero(),
                       const Quat& q_WB = Quat::Identity()) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0.0) shape.calculateLocalInertia(static_cast<btScalar>(mass), inertia);
    bodies.push_back(
        std::make_unique<btRigidBody>(static_cast<btScalar>(mass), nullptr, &shape, inertia));
    bodies.back()->setWorldTransform(toBullet(p_W, q_WB));
    bodies.back()->setInterpolationWorldTransform(toBullet(p_W, q_WB));
    bodies.back()->updateInertiaTensor();
    world.addRigidBody(bodies.back().get());
    return *bodies.back();
  }

  btRigidBody& addCube(double mass, double half = 0.02, const Vec3& p_W = Vec3::Zero(),
                       const Quat& q_WB = Quat::Identity()) {
    return addBody(makeShape<btBoxShape>(toBullet(Vec3(half, half, half))), mass, p_W, q_WB);
  }

  /// One sub-step of the host.
  void step(double dt) { world.stepSimulation(static_cast<btScalar>(dt), 0); }
};

/// A listener built from two functions.
template <typename Before, typename After>
class Listener final : public HostStepListener {
 public:
  Listener(Before before, After after) : before_(before), after_(after) {}
  void beforeHostStep(double dt) noexcept override { before_(dt); }
  void afterHostStep(double dt) noexcept override { after_(dt); }

 private:
  Before before_;
  After after_;
};

}  // namespace tandem::test
