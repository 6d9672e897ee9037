#include "coordination/src/geometry/convex_polyhedron.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "coordination/src/geometry/contact_geometry.h"
#include "support/solids.h"

namespace tandem {
namespace {

std::string refusal(const std::vector<Vec3>& corners, const std::vector<std::vector<int>>& faces) {
  try {
    ConvexPolyhedron{corners, faces};
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ConvexPolyhedron, RefusesWhatIsNoConvexSolid) {
  const test::Solid cube = test::makeBoxSolid({1, 1, 1});
  EXPECT_EQ(refusal(cube.corners, cube.faces), "");
  auto faces = cube.faces;
  faces.pop_back();
  EXPECT_NE(refusal(cube.corners, faces).find("not closed"), std::string::npos);
  faces = cube.faces;
  std::swap(faces[0][1], faces[0][3]);
  EXPECT_NE(refusal(cube.corners, faces).find("run along alike"), std::string::npos);
  faces = cube.faces;
  faces[2][1] = 8;
  EXPECT_NE(refusal(cube.corners, faces).find("does not exist"), std::string::npos);
  auto corners = cube.corners;
  corners[3] *= 0.2;  // a dent
  EXPECT_NE(refusal(corners, cube.faces).find("not convex"), std::string::npos);
  corners = cube.corners;
  for (Vec3& p : corners) p.z() *= 1e-8;
  EXPECT_NE(refusal(corners, cube.faces), "");
  corners[0].x() = std::nan("");
  EXPECT_NE(refusal(corners, cube.faces).find("not finite"), std::string::npos);
  // The faces are inside out.
  for (auto& face : faces = cube.faces) std::swap(face[1], face[3]);
  EXPECT_NE(refusal(cube.corners, faces), "");
}

TEST(ConvexHull, RoundingTakesOffTheGap) {
  const test::Solid solid = test::makeOctahedron({0.2, 0.3, 0.25});
  const Shape sharp = test::makeHull(solid), round = test::makeHull(solid, 0.05);
  for (const Vec3& p : {Vec3(0.3, 0.2, 0.1), Vec3(0.21, 0.0, 0.0), Vec3(0.01, 0.02, 0.0)}) {
    const auto a = findSphereContact(p, 0.01, sharp, Vec3::Zero(), Quat::Identity());
    const auto b = findSphereContact(p, 0.01, round, Vec3::Zero(), Quat::Identity());
    EXPECT_NEAR(b.gap, a.gap - 0.05, 1e-15);
    EXPECT_EQ(b.n_W, a.n_W);
  }
}

}  // namespace
}  // namespace tandem
