#pragma once

#include <algorithm>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

namespace tandem {

/// Index of `object` in the world's list, or -1 if the world does not have it. Compares addresses
/// only: the object may have been deleted. `hint` is its last index, which saves the search.
[[nodiscard]] inline int findInWorld(const btCollisionWorld& world, const btCollisionObject* object,
                                     int hint = -1) noexcept {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  if (hint >= 0 && hint < objects.size() && objects[hint] == object) return hint;
  for (int i = 0; i < objects.size(); ++i) {
    if (objects[i] == object) return i;
  }
  return -1;
}

/// Lists all bodies with joints, sorted: a body's own list has only joints that disable its
/// contacts. Allocates.
inline void listJointed(const btDiscreteDynamicsWorld& world,
                        std::vector<const btRigidBody*>& jointed) {
  jointed.clear();
  for (int i = 0; i < world.getNumConstraints(); ++i) {
    jointed.push_back(&world.getConstraint(i)->getRigidBodyA());
    jointed.push_back(&world.getConstraint(i)->getRigidBodyB());
  }
  std::sort(jointed.begin(), jointed.end());
}

}  // namespace tandem
