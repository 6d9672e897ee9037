#include "scene/open_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

#include "scene/mesh_parts.h"

namespace tandem::view {
namespace {

constexpr btScalar kHalfPlane = 1;  // of the square that stands for a plane [m]

/// Adds a polygon and its back, because a renderer culls what faces away.
template <std::size_t kCount>
void addBothSides(ShapeMesh& mesh, std::array<btVector3, kCount> corners) {
  addFacet(mesh, corners);
  std::reverse(corners.begin(), corners.end());
  addFacet(mesh, corners);
}

class TriangleCollector : public btTriangleCallback {
 public:
  void processTriangle(btVector3* triangle, int /*part*/, int /*index*/) override {
    addBothSides(mesh, std::array{triangle[0], triangle[1], triangle[2]});
  }
  ShapeMesh mesh;
};

}  // namespace

ShapeMesh makeOpenMesh(const btConcaveShape& shape) {
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  TriangleCollector collector;
  shape.processAllTriangles(&collector, -far, far);
  return std::move(collector.mesh);
}

ShapeMesh makePlaneMesh(const btStaticPlaneShape& shape) {
  const btVector3 nearest = shape.getPlaneNormal() * shape.getPlaneConstant();
  btVector3 across, up;
  btPlaneSpace1(shape.getPlaneNormal(), across, up);
  across *= kHalfPlane;
  up *= kHalfPlane;
  ShapeMesh mesh;
  addBothSides(mesh, std::array{nearest - across - up, nearest + across - up, nearest + across + up,
                                nearest - across + up});
  return mesh;
}

}  // namespace tandem::view
