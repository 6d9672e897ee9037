#pragma once

#include <vector>

#include <BulletCollision/CollisionShapes/btCollisionShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

class HapticBody;

/// Checks in each host step whether all of many sleeping bodies are as they were left. Bullet tells
/// nobody when a host calls a setter, so all of them are read. They stand one after another in
/// memory, and are compared without a branch per number.
///
/// A change is what HapticBody::isUndisturbed() calls one. For the thread that steps the world.
class SleepWatch {
 public:
  /// `world` must outlive this object.
  explicit SleepWatch(const btDiscreteDynamicsWorld& world) : world_(world) {}

  /// Stores how these bodies are now. False, and nothing is stored, if one is disturbed already.
  /// May allocate.
  bool remember(const std::vector<HapticBody*>& bodies);
  [[nodiscard]] bool isEmpty() const noexcept { return looks_.empty(); }

  /// Pre-tick. False once the host has woken, moved, pushed, changed or removed a body, or another
  /// body has its index in the world. Compares addresses first: a body may have been deleted.
  [[nodiscard]] bool isUndisturbed() const noexcept;
  /// Post-tick of a step that began undisturbed. True if Bullet has all of them asleep.
  [[nodiscard]] bool areAsleep() const noexcept;

 private:
  struct Look {
    const btRigidBody* body;
    const btBroadphaseProxy* proxy;
    const btCollisionShape* shape;
    const int* number_in_body;
    int world_index, number, broadphase_id, group, mask, flags;
    btScalar inverse_mass, friction, restitution, rolling_friction, spinning_friction;
    btTransform pose;
    btVector3 gravity, inverse_inertia, linear_factor, angular_factor;

    [[nodiscard]] bool isUnchanged() const noexcept;
  };
  /// Bodies often have the same shape.
  struct ShapeLook {
    const btCollisionShape* shape;
    btScalar margin;
    btVector3 scaling;
  };

  const btDiscreteDynamicsWorld& world_;
  std::vector<Look> looks_;
  std::vector<ShapeLook> shapes_;
};

}  // namespace tandem
#pragma GCC visibility pop
