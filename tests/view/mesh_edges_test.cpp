// Edges of meshes, by which ghosts are drawn.

#include "gl/mesh_edges.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "view/small_meshes.h"

namespace tandem::view {
namespace {

std::ptrdiff_t countSharp(const std::vector<MeshEdge>& edges) {
  return std::count_if(edges.begin(), edges.end(), [](const MeshEdge& e) { return e.is_sharp; });
}

TEST(MeshEdges, OfABoxAreTwelve) {
  const auto edges = computeMeshEdges(*test::makeBox(Vec3(0.01, 0.02, 0.03)));
  EXPECT_EQ(edges.size(), 12U);
  EXPECT_EQ(countSharp(edges), 12);
  for (const MeshEdge& edge : edges) EXPECT_NEAR(edge.n1_B.dot(edge.n2_B), 0.0, 1e-12);
}

TEST(MeshEdges, OfABallAreNone) {
  for (const double radius : {1e-3, 0.02, 10.0})
    EXPECT_TRUE(computeMeshEdges(*test::makeBall(radius)).empty()) << radius;
}

TEST(MeshEdges, OfAnOpenSurfaceAreItsRim) {
  ShapeMesh triangle;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)})
    triangle.vertices.push_back(test::makeVertex(p, Vec3::UnitZ()));
  triangle.indices = {0, 1, 2};
  EXPECT_EQ(countSharp(computeMeshEdges(triangle)), 3);
  // A triangle without an area adds none.
  triangle.indices.insert(triangle.indices.end(), {0, 0, 1, 1, 1, 1});
  EXPECT_EQ(computeMeshEdges(triangle).size(), 3U);
}

TEST(MeshEdges, OfAnEmptyMeshAreNone) { EXPECT_TRUE(computeMeshEdges(ShapeMesh()).empty()); }

// The outline of a ball closes: each end of a piece is an end of one other.
TEST(GhostLines, OutlineOfABallIsClosed) {
  Solid solid;
  solid.mesh = test::makeBall(0.05);
  solid.p_WB = Vec3(0.1, 0.2, 0.3);
  solid.q_WB = Quat(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  std::vector<Line> lines;
  appendGhostLines(solid, {}, Vec3(0.5, -0.4, 0.6), lines);
  EXPECT_GT(lines.size(), 20U);
  for (const Line& line : lines)
    for (const Vec3& end : {line.from_W, line.to_W}) {
      EXPECT_NEAR((end - solid.p_WB).norm(), 0.05, 1e-3);
      EXPECT_EQ(std::count_if(lines.begin(), lines.end(),
                              [&](const Line& other) {
                                return (other.from_W - end).norm() < 1e-7 ||
                                       (other.to_W - end).norm() < 1e-7;
                              }),
                2);
    }
}

}  // namespace
}  // namespace tandem::view
