#pragma once

#include <optional>
#include <vector>

#include "tandem/coordination/types.h"

#include "geometry/quick_hull.h"

namespace tandem {

/// Corners of faces, one face after the other.
struct FaceList {
  std::vector<int> corners;
  std::vector<int> ends;  ///< by face: end of its corners
};

/// Normal of the plane that fits a face's corners, twice as long as its area [m^2] (Newell).
[[nodiscard]] Vec3 computeArea(const std::vector<Vec3>& points, const int* corners, int count);

/// Joins triangles in one plane to faces with more corners. How a flat face was cut into triangles
/// is a matter of chance, and must not decide what it does. Nothing if rounding folded the surface:
/// if it is not convex within 10 `on_face`.
[[nodiscard]] std::optional<FaceList> joinFlatFaces(const std::vector<Vec3>& points,
                                                    const HullTriangles& hull);

}  // namespace tandem
