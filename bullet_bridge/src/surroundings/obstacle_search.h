#pragma once

#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>

#include "coordination/src/island/island.h"
#include "surroundings/known_shapes.h"
#include "surroundings/regions.h"

namespace tandem {

/// Adds to `found` the static objects of the world that may reach into the region and answer
/// contact, each once. Moving, kinematic, ghost and soft objects are left out. Asks the world's
/// broadphase.
void findStaticObjects(btCollisionWorld& world, const Region& region,
                       std::vector<btCollisionObject*>& found);

/// Sorts by the order in which the host added the objects: the same on every peer, whatever the
/// broadphase does.
void sortAsAdded(std::vector<btCollisionObject*>& objects);

/// Adds to `obstacles` what of a shape of `object` at a pose the island knows itself and reaches
/// into one of the regions, also inside compounds. Other shapes are skipped.
void appendObstacles(const btCollisionObject& object, const btCollisionShape& shape,
                     const btTransform& pose, const std::vector<Region>& regions,
                     KnownShapes& known, std::vector<Obstacle>& obstacles);

}  // namespace tandem
