#include "coordination/src/geometry/compound_parts.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/geometry/contact_geometry.h"
#include "support/random.h"
#include "support/solids.h"

namespace tandem {
namespace {

constexpr std::uint64_t kSeed = 20260301;

std::string refusal(const std::vector<ShapePart>& shapes) {
  try {
    static_cast<void>(makeCompound(shapes));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(CompoundParts, RefusesWhatIsNoSolidOfABody) {
  EXPECT_NE(refusal({}).find("needs a shape"), std::string::npos);
  EXPECT_NE(refusal({{Plane{}}}).find("a plane cannot be part"), std::string::npos);
  EXPECT_NE(refusal({{Sphere{-1.0}}}).find("sphere radius = -1"), std::string::npos);
  EXPECT_NE(refusal({{Compound{}}}).find("needs parts"), std::string::npos);
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal({{Sphere{1.0}, Vec3(0, no_number, 0)}}).find("position"), std::string::npos);
  EXPECT_NE(refusal({{Sphere{1.0}, Vec3::Zero(), Quat(0, 0, 0, 0)}}).find("orientation"),
            std::string::npos);
}

TEST(CompoundParts, CompoundsInCompoundsBecomeTheirParts) {
  test::Random random(kSeed);
  const Quat q_inner = random.rotation(), q_outer = random.rotation();
  const Compound inner = makeCompound(
      {{Sphere{0.1}, Vec3(0.3, 0, 0)}, {Box{{0.1, 0.2, 0.3}}, Vec3(0, 1, 0), q_inner}});
  const Compound outer = makeCompound({{Sphere{0.2}}, {inner, Vec3(0, 0, 2), q_outer}});
  const auto& parts = outer.parts->all();
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(std::get<Sphere>(parts[0].shape).radius, 0.2);
  EXPECT_LT((parts[1].p_BC - (Vec3(0, 0, 2) + q_outer * Vec3(0.3, 0, 0))).norm(), 1e-15);
  EXPECT_LT((parts[2].p_BC - (Vec3(0, 0, 2) + q_outer * Vec3(0, 1, 0))).norm(), 1e-15);
  EXPECT_LT(parts[2].q_BC.angularDistance(q_outer * q_inner), 1e-7);
}

TEST(CompoundParts, BallsHoldThePartsAndNotMuchMore) {
  const Compound two = makeCompound({{Sphere{0.1}, Vec3(0.5, 0, 0)}, {Sphere{0.2}}});
  EXPECT_DOUBLE_EQ(computeBoundingRadius(two), 0.6);
  EXPECT_DOUBLE_EQ(computeReach(two, Vec3::UnitX()), 0.6);
  EXPECT_DOUBLE_EQ(computeReach(two, -Vec3::UnitX()), 0.2);

  // Corners of a hull are often far from its origin.
  std::vector<Vec3> corners;
  for (const Vec3& p : test::makeBoxSolid(Vec3::Constant(0.1)).corners)
    corners.push_back(p + Vec3(5, 0, 0));
  const ConvexHull far{
      std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(corners))};
  const Compound compound = makeCompound({{far, Vec3(0, 1, 0)}});
  const CompoundParts::Part& part = compound.parts->all().front();
  EXPECT_LT((part.middle_B - Vec3(5, 1, 0)).norm(), 1e-12);
  EXPECT_LT(part.radius, 0.18);
}

/// A solid of any kind, about 0.1 m large.
Shape drawShape(test::Random& random) {
  const double a = random.uniform(0.02, 0.1), b = random.uniform(0.02, 0.1);
  const double c = random.uniform(0.02, 0.1);
  switch (random.below(7)) {
    case 0:
      return Sphere{a};
    case 1:
      return Box{{a, b, c}};
    case 2:
      return Capsule{a, b, Axis::kX};
    case 3:
      return Cylinder{a, b, Axis::kZ};
    case 4:
      return Cone{a, b, Axis::kY, 0.1 * c};
    case 5:
      return test::makeHull(test::makeOctahedron({a, b, c}), 0.1 * a);
    default:
      return test::makeMesh(test::cutIntoTriangles(test::makeBoxSolid({a, b, c})));
  }
}

// Found by the parts' own frames, or with each part where it is in the world: the same.
TEST(CompoundParts, TheNearestPartIsTheOneOfTheShapesThemselves) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  for (int i = 0; i < 20000 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("compound " + std::to_string(i));
    std::vector<ShapePart> shapes(static_cast<std::size_t>(1 + random.below(5)));
    for (ShapePart& shape : shapes)
      shape = {drawShape(random), random.inCube(0.2), random.rotation()};
    const Compound compound = makeCompound(shapes);
    const Vec3 p_WB = random.inCube(1.0), p_W = p_WB + random.inCube(0.4);
    const Quat q_WB = random.rotation();
    const SphereContact found = findSphereContact(p_W, 0.01, compound, p_WB, q_WB);
    double least = std::numeric_limits<double>::infinity();
    for (const ShapePart& shape : shapes) {
      const SphereContact own =
          findSphereContact(p_W, 0.01, shape.shape, p_WB + q_WB * shape.p_BC, q_WB * shape.q_BC);
      least = std::min(least, own.gap);
    }
    EXPECT_NEAR(found.gap, least, 1e-13);
    EXPECT_NEAR((found.p_W + (found.gap + 0.01) * found.n_W - p_W).norm(), 0.0, 1e-13);
    for (const CompoundParts::Part& part : compound.parts->all()) {
      const Vec3 on_part = p_WB + q_WB * part.middle_B;
      const SphereContact own =
          findSphereContact(p_W, 0.0, part.shape, p_WB + q_WB * part.p_BC, q_WB * part.q_BC);
      EXPECT_GE(own.gap, (p_W - on_part).norm() - part.radius - 1e-13) << "outside its ball";
    }
  }
}

}  // namespace
}  // namespace tandem
