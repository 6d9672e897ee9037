#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "scene/shape_mesh.h"

namespace tandem::view {

/// Makes both sides of all triangles of a mesh, a height field or any other concave shape. Bullet
/// does not say which side is outside.
[[nodiscard]] ShapeMesh makeOpenMesh(const btConcaveShape& shape);

/// Makes both sides of a square of 2 m about the point of the plane that is nearest to the origin.
[[nodiscard]] ShapeMesh makePlaneMesh(const btStaticPlaneShape& shape);

}  // namespace tandem::view
