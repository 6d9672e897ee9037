#include "coordination/src/geometry/convex_polyhedron.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "coordination/src/geometry/contact_geometry.h"
#include "support/random.h"
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

// The points lie in rows and planes, so an incremental hull meets every kind of tie.
TEST(ConvexPolyhedron, HullOfAGridIsABox) {
  std::vector<Vec3> points;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 3; ++y)
      for (int z = 0; z <= 5; ++z)
        points.emplace_back(0.1 * x - 0.2, 0.1 * y - 0.15, 0.1 * z - 0.25);
  const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
  EXPECT_EQ(hull.vertices().size(), 8u);
  EXPECT_EQ(hull.faces().size(), 12u);
  const Shape shape = ConvexHull{std::make_shared<const ConvexPolyhedron>(hull), 0.0};
  const Shape box = Box{{0.2, 0.15, 0.25}};
  test::Random random(20090303);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.inCube(0.5);
    const auto find = [&](const Shape& one) {
      return findSphereContact(p, 0.01, one, Vec3::Zero(), Quat::Identity());
    };
    EXPECT_NEAR(find(shape).gap, find(box).gap, 1e-15);
    EXPECT_LT((find(shape).n_W - find(box).n_W).norm(), 1e-12);
  }
}

// Each face of a hull lies in a plane through its points, with all other points behind it.
TEST(ConvexPolyhedron, HullHoldsAllPoints) {
  test::Random random(20090304);
  const auto uniform = [&] { return random.uniform(-1.0, 1.0); };
  for (int scene = 0; scene < 200; ++scene) {
    SCOPED_TRACE(scene);
    std::vector<Vec3> points;
    const int count = 4 + scene % 60;
    for (int i = 0; i < count; ++i) {
      Vec3 p(uniform(), uniform(), uniform());
      if (scene % 3 == 1) p.normalize();  // puts all points on a ball: all are corners
      if (scene % 3 == 2) p = (4.0 * p).array().round() / 4.0;  // puts all points on a lattice
      points.push_back(p);
    }
    try {
      const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
      for (const auto& face : hull.faces())
        for (const Vec3& p : points) EXPECT_LT(face.normal.dot(p) - face.offset, 4e-7);
      if (scene % 3 == 1) {
        EXPECT_EQ(hull.vertices().size(), points.size());
      }
      // Euler's formula for a hull of triangles only.
      EXPECT_EQ(hull.faces().size(), 2 * hull.vertices().size() - 4);
    } catch (const std::invalid_argument&) {
      EXPECT_LT(count, 6) << "only few points on a lattice may lie in a plane";
    }
  }
}

TEST(ConvexPolyhedron, HullNeedsAVolume) {
  EXPECT_THROW((void)ConvexPolyhedron::makeHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
               std::invalid_argument);
  EXPECT_THROW((void)ConvexPolyhedron::makeHull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}),
               std::invalid_argument);
  EXPECT_THROW((void)ConvexPolyhedron::makeHull(std::vector<Vec3>(5, Vec3::Zero())),
               std::invalid_argument);
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
