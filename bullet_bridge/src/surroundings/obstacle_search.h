#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "coordination/src/island/island.h"
#include "surroundings/known_shapes.h"
#include "surroundings/regions.h"

namespace tandem {

/// True for a static object with contact response, one whose simulation is disabled, and the fixed
/// base of a multi-body.
[[nodiscard]] bool isObstacle(const btCollisionObject& object) noexcept;

/// Adds to `found` each obstacle that may reach into the region, once. Moving, kinematic, ghost and
/// soft objects are skipped. Uses the world's broadphase.
void findStaticObjects(btCollisionWorld& world, const Region& region,
                       std::vector<btCollisionObject*>& found);

/// Sorts by the order in which the host added the objects. It is equal on every peer, unlike that
/// of the broadphase.
void sortAsAdded(std::vector<btCollisionObject*>& objects);

/// Adds the parts of a shape that reach into one of the regions and that the island supports, also
/// inside compounds. `shape` belongs to `object` and is at `pose`; `part` counts its shapes. Other
/// shapes are skipped.
void appendObstacles(const btCollisionObject& object, const btCollisionShape& shape,
                     const btTransform& pose, const std::vector<Region>& regions,
                     KnownShapes& known, int& part, std::vector<Obstacle>& obstacles);

/// Tells which obstacles were not in the list `before`, or elsewhere.
void noteChanges(const std::vector<Obstacle>& before, std::vector<Obstacle>& now);

}  // namespace tandem
