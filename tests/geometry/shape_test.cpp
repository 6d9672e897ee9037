#include "tandem/coordination/shape.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kNoNumber = std::nan("");

std::string refusal(const Shape& shape) {
  try {
    checkShape(shape);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Shape, BoundingBallJustHoldsTheShape) {
  EXPECT_DOUBLE_EQ(computeBoundingRadius(Sphere{0.3}), 0.3);
  EXPECT_DOUBLE_EQ(computeBoundingRadius(Box{{0.2, 0.3, 0.6}}), 0.7);
  EXPECT_DOUBLE_EQ(computeBoundingRadius(Capsule{0.1, 0.4}), 0.5);
  EXPECT_DOUBLE_EQ(computeBoundingRadius(Cone{0.3, 0.4, Axis::kX, 0.1}), 0.6);
  EXPECT_EQ(computeBoundingRadius(Plane{}), kInfinity);
}

TEST(Shape, AConeReachesToItsTipAndItsRim) {
  const Cone cone{0.3, 0.4, Axis::kZ, 0.1};
  EXPECT_DOUBLE_EQ(computeReach(cone, Vec3::UnitZ()), 0.5);
  EXPECT_DOUBLE_EQ(computeReach(cone, -Vec3::UnitZ()), 0.5);
  EXPECT_DOUBLE_EQ(computeReach(cone, Vec3::UnitY()), 0.4);
  EXPECT_DOUBLE_EQ(computeReach(cone, Vec3(0.6, 0.0, -0.8)), 0.6);
}

TEST(Shape, AcceptsWhatIsDocumented) {
  EXPECT_EQ(refusal(Cone{1e-9, 1e6}), "");
  EXPECT_EQ(refusal(Sphere{1e-9}), "");
  EXPECT_EQ(refusal(Box{{0.1, 1e-6, 1e6}}), "");
  EXPECT_EQ(refusal(Capsule{0.1, 0.0}), "");
  EXPECT_EQ(refusal(Plane{Vec3(0.6, 0.0, -0.8), -3.0}), "");
  EXPECT_EQ(refusal(Plane{(1.0 + 9e-7) * Vec3::UnitZ(), 0.0}), "");
}

TEST(Shape, RefusesBadSizesByName) {
  for (const double bad : {0.0, -1.0, kInfinity, kNoNumber}) {
    EXPECT_NE(refusal(Sphere{bad}).find("sphere radius"), std::string::npos) << bad;
    EXPECT_NE(refusal(Box{{bad, 1, 1}}).find("half_extents.x"), std::string::npos) << bad;
    EXPECT_NE(refusal(Box{{1, bad, 1}}).find("half_extents.y"), std::string::npos) << bad;
    EXPECT_NE(refusal(Box{{1, 1, bad}}).find("half_extents.z"), std::string::npos) << bad;
    EXPECT_NE(refusal(Capsule{bad, 1.0}).find("capsule radius"), std::string::npos) << bad;
    EXPECT_NE(refusal(Cone{bad, 1.0}).find("cone radius"), std::string::npos) << bad;
    EXPECT_NE(refusal(Cone{1.0, bad}).find("cone half_length"), std::string::npos) << bad;
  }
  for (const double bad : {-1e-9, kInfinity, kNoNumber}) {
    EXPECT_NE(refusal(Capsule{1.0, bad}).find("half_length"), std::string::npos) << bad;
    EXPECT_NE(refusal(Cone{1, 1, Axis::kX, bad}).find("rounding"), std::string::npos) << bad;
  }
}

TEST(Shape, RefusesPlaneWithoutUnitNormalOrFiniteOffset) {
  EXPECT_NE(refusal(Plane{Vec3::Zero(), 0.0}).find("normal_B"), std::string::npos);
  EXPECT_NE(refusal(Plane{Vec3(1, 1, 0), 0.0}).find("normal_B"), std::string::npos);
  EXPECT_NE(refusal(Plane{Vec3(kNoNumber, 1, 0), 0.0}).find("normal_B"), std::string::npos);
  EXPECT_NE(refusal(Plane{(1.0 + 2e-6) * Vec3::UnitZ(), 0.0}).find("normal_B"), std::string::npos);
  EXPECT_NE(refusal(Plane{Vec3::UnitY(), kInfinity}).find("offset"), std::string::npos);
}

TEST(Shape, RefusalSaysTheValue) {
  EXPECT_EQ(refusal(Sphere{-0.25}), "sphere radius = -0.25: must be finite and above 0 m");
}

}  // namespace
}  // namespace tandem
