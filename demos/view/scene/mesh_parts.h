#pragma once

#include <cstdint>
#include <span>

#include <LinearMath/btTransform.h>

#include "scene/shape_mesh.h"

namespace tandem::view {

/// Adds a vertex at `p` [m] with the unit normal `n`, and gives back its index.
std::uint32_t addVertex(ShapeMesh& mesh, const btVector3& p, const btVector3& n);

/// Adds a flat polygon as a fan of triangles. Its corners [m] are convex and counter-clockwise as
/// seen from outside. One without an area adds nothing.
void addFacet(ShapeMesh& mesh, std::span<const btVector3> corners);

/// Adds the surface of a part P of a body B at its pose in the body's frame.
void appendPart(ShapeMesh& mesh, const ShapeMesh& part, const btTransform& X_BP);

/// Scales a surface about its origin by a positive factor.
void scaleMesh(ShapeMesh& mesh, btScalar factor);

/// The surface of a box about the origin, with half its sizes [m].
[[nodiscard]] ShapeMesh makeBoxMesh(const btVector3& half_extents);

}  // namespace tandem::view
