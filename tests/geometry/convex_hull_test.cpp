// A hull of points is closed, convex and around all of them, whatever the points.

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/geometry/convex_polyhedron.h"
#include "support/random.h"

namespace tandem {
namespace {

/// Largest distance of a point from the middle of all, doubled [m].
double computeSize(const std::vector<Vec3>& points) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : points) middle += p / static_cast<double>(points.size());
  double size = 0.0;
  for (const Vec3& p : points) size = std::max(size, 2.0 * (p - middle).norm());
  return size;
}

int countSides(const ConvexPolyhedron& hull) {
  int sides = 0;
  for (const auto& face : hull.faces()) sides += face.count;
  return sides;
}

/// True if a side runs the other way along another face. `tolerance` [m].
bool hasTwin(const ConvexPolyhedron& hull, const ConvexPolyhedron::Side& side) {
  const Vec3 end = side.start + side.length * side.along;
  const double tolerance = 1e-9 * hull.boundingRadius();
  for (const auto& face : hull.faces())
    for (int i = 0; i < face.count; ++i) {
      const auto& other = hull.sides(face)[i];
      const Vec3 other_end = other.start + other.length * other.along;
      if ((other.start - end).norm() < tolerance && (other_end - side.start).norm() < tolerance)
        return true;
    }
  return false;
}

/// `share` of the size: tolerance. `every`: checks one face of so many for its sides, which takes
/// long.
void expectHullOf(const std::vector<Vec3>& points, const ConvexPolyhedron& hull,
                  double share = 1e-6, int every = 1) {
  const double tolerance = share * computeSize(points);
  // Euler's formula: corners - edges + faces = 2.
  const int sides = countSides(hull);
  EXPECT_EQ(static_cast<int>(hull.vertices().size() + hull.faces().size()), sides / 2 + 2);
  EXPECT_EQ(sides % 2, 0);
  for (std::size_t f = 0; f < hull.faces().size(); ++f) {
    const auto& face = hull.faces()[f];
    double highest = -std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) highest = std::max(highest, face.normal.dot(p) - face.offset);
    EXPECT_LT(highest, tolerance);
    EXPECT_GT(highest, -tolerance);
    for (int i = 0; i < face.count; ++i) {
      const auto& side = hull.sides(face)[i];
      EXPECT_LT(std::abs(face.normal.dot(side.start) - face.offset), tolerance);
      // The face is convex, too.
      for (int k = 0; k < face.count; ++k)
        EXPECT_LT(side.outward.dot(hull.sides(face)[k].start - side.start), tolerance);
      if (f % static_cast<std::size_t>(every) != 0) continue;
      EXPECT_TRUE(hasTwin(hull, side));
    }
  }
}

std::vector<Vec3> makePointsOnBall(std::size_t count) {
  test::Random random(20090305);
  std::vector<Vec3> points;
  while (points.size() < count) points.push_back(0.05 * Vec3(random.inCube(1.0)).normalized());
  return points;
}

// The points lie in rows and planes, so an incremental hull meets every kind of tie.
TEST(HullOfPoints, GridIsABox) {
  std::vector<Vec3> points;
  for (int x = 0; x <= 4; ++x)
    for (int y = 0; y <= 3; ++y)
      for (int z = 0; z <= 5; ++z)
        points.emplace_back(0.1 * x - 0.2, 0.1 * y - 0.15, 0.1 * z - 0.25);
  const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
  EXPECT_EQ(hull.vertices().size(), 8u);
  EXPECT_EQ(hull.faces().size(), 6u);
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

enum class Kind {
  kInCube,
  kOnBall,
  kOnLattice,
  kTurnedLattice,
  kSingle,
  kFlatStone,
  kNearlyOnPlane
};

std::vector<Vec3> makePoints(Kind kind, int count, test::Random& random) {
  const Vec3 axis = random.inCube(1.0).normalized();
  const Quat turn(Eigen::AngleAxisd(random.uniform(0.0, 3.0), axis));
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 p = random.inCube(1.0);
    if (kind == Kind::kOnBall) p.normalize();
    if (kind == Kind::kOnLattice || kind == Kind::kTurnedLattice || kind == Kind::kSingle)
      p = (4.0 * p).array().round() / 4.0;
    if (kind == Kind::kTurnedLattice || kind == Kind::kSingle) p = turn * p;
    if (kind == Kind::kSingle) p = p.cast<float>().cast<double>();
    if (kind == Kind::kFlatStone) p.z() *= 1e-3;
    if (kind == Kind::kNearlyOnPlane && i % 2 == 0) p.z() = 1.0 + 1e-7 * random.uniform(-1.0, 1.0);
    points.push_back(p);
    if (i % 5 == 0) points.push_back(p);  // twice
  }
  return points;
}

class HullOfPoints : public ::testing::TestWithParam<Kind> {};

TEST_P(HullOfPoints, IsClosedConvexAndHoldsAll) {
  test::Random random(20090304);
  int made = 0;
  for (int scene = 0; scene < 300; ++scene) {
    SCOPED_TRACE(scene);
    const int count = 4 + scene % 80;
    const std::vector<Vec3> points = makePoints(GetParam(), count, random);
    try {
      const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
      // Points about a plane may need a coarser hull.
      const bool is_rough = GetParam() == Kind::kSingle || GetParam() == Kind::kNearlyOnPlane;
      expectHullOf(points, hull, is_rough ? 1e-4 : 1e-6);
      ++made;
    } catch (const std::invalid_argument& error) {
      EXPECT_LT(count, 8) << error.what() << ": only few points may lie in a plane";
    }
  }
  EXPECT_GT(made, 280);
}

INSTANTIATE_TEST_SUITE_P(Kinds, HullOfPoints,
                         ::testing::Values(Kind::kInCube, Kind::kOnBall, Kind::kOnLattice,
                                           Kind::kTurnedLattice, Kind::kSingle, Kind::kFlatStone,
                                           Kind::kNearlyOnPlane));

TEST(HullOfPoints, FourMakeATetrahedron) {
  test::Random random(20090307);
  for (int scene = 0; scene < 100; ++scene) {
    std::vector<Vec3> points;
    while (points.size() < 4) points.push_back(random.inCube(0.1));
    const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
    EXPECT_EQ(hull.faces().size(), 4u);
    expectHullOf(points, hull);
  }
}

// All points of a ball are corners: the largest hull that so many points can have.
TEST(HullOfPoints, ThousandsOnABallAreAllCorners) {
  const std::vector<Vec3> points = makePointsOnBall(4000);
  const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
  EXPECT_EQ(hull.vertices().size(), points.size());
  EXPECT_GT(hull.faces().size(), 2 * points.size() - 100);
  expectHullOf(points, hull, 1e-6, 500);
}

// Where the bits of a hull may depend on chance, sites would disagree.
TEST(HullOfPoints, IsTheSameEachTime) {
  const std::vector<Vec3> points = makePointsOnBall(500);
  const ConvexPolyhedron one = ConvexPolyhedron::makeHull(points);
  const ConvexPolyhedron other = ConvexPolyhedron::makeHull(std::vector<Vec3>(points));
  ASSERT_EQ(one.faces().size(), other.faces().size());
  for (std::size_t f = 0; f < one.faces().size(); ++f)
    EXPECT_EQ(one.faces()[f].normal, other.faces()[f].normal);
}

// Corners of a box that is turned are not in one plane to the bit.
TEST(HullOfPoints, TurnedBoxInSinglePrecisionHasSixFaces) {
  test::Random random(20090306);
  for (int scene = 0; scene < 200; ++scene) {
    const Vec3 half = random.inCube(0.04).cwiseAbs() + Vec3::Constant(0.01);
    const Quat turn(Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.inCube(1.0).normalized()));
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner((i & 1) ? half.x() : -half.x(), (i & 2) ? half.y() : -half.y(),
                        (i & 4) ? half.z() : -half.z());
      points.push_back((turn * corner).cast<float>().cast<double>());
    }
    const ConvexPolyhedron hull = ConvexPolyhedron::makeHull(points);
    EXPECT_EQ(hull.faces().size(), 6u);
    expectHullOf(points, hull);
  }
}

void expectRefused(const std::vector<Vec3>& points) {
  EXPECT_THROW((void)ConvexPolyhedron::makeHull(points), std::invalid_argument);
}

TEST(HullOfPoints, NeedAVolume) {
  expectRefused({});
  expectRefused({{0, 0, 0}});
  expectRefused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  expectRefused({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  expectRefused({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}});
  expectRefused(std::vector<Vec3>(5, Vec3::Zero()));
}

TEST(HullOfPoints, NeedFiniteNumbers) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<Vec3> points = makePointsOnBall(20);
    points[7].y() = bad;
    expectRefused(points);
  }
}

}  // namespace
}  // namespace tandem
