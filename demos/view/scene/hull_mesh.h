#pragma once

#include <array>
#include <optional>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include "scene/shape_mesh.h"

namespace tandem::view {

/// Corners of a shape that is the hull of points, with its scaling and without its margin [m]. None
/// for shapes of other kinds.
[[nodiscard]] std::optional<std::vector<btVector3>> findHullPoints(const btCollisionShape& shape);

/// Makes the hull of points with a flat normal for each face. Points in a plane give both of its
/// sides; points on a line give nothing.
[[nodiscard]] ShapeMesh makeHullMesh(const std::vector<btVector3>& points);

/// The furthest points of a convex shape, its margin included, in some 400 directions [m].
[[nodiscard]] std::vector<btVector3> findSupports(const btConvexShape& shape);

/// Directions to the corners, edges and sides of a cube, not normalised.
[[nodiscard]] std::array<btVector3, 26> makeCubeDirections();

}  // namespace tandem::view
