#pragma once

#include <memory>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/coordination/types.h"

#include "regions.h"

class btCollisionAlgorithm;

namespace tandem {

/// A dynamic body of the host as the private solver has it: same shape, mass, friction and factors;
/// neither damping nor gyroscopic term nor forces, which the island's prediction has.
[[nodiscard]] std::unique_ptr<btRigidBody> copyBody(const btRigidBody& original);

/// A static object of the host as the private solver has it.
struct ObstacleCopy {
  explicit ObstacleCopy(btCollisionObject& host_object);

  /// Puts the copy where the original is, seen from `origin_W`.
  void place(const Vec3& origin_W);

  btCollisionObject* original;         ///< the host may have deleted it: compare, do not read
  const btCollisionShape* host_shape;  ///< another one: another object at the same address
  std::unique_ptr<btStaticPlaneShape>
      plane;  ///< own shape for a plane, through its object's origin
  btCollisionObject object;
  Region bounds;            ///< around the copy
  std::vector<bool> meets;  ///< by body: the host lets them touch
  std::vector<btCollisionAlgorithm*>
      algorithms;  ///< by body: Bullet's narrowphase while they are near
};

}  // namespace tandem
