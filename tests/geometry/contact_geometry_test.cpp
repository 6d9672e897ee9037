#include "coordination/src/geometry/contact_geometry.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/solids.h"

namespace tandem {
namespace {

constexpr double kRadius = 0.01;  // radius of the sphere [m]
constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-14;

const Vec3 kHalfExtents(0.1, 0.2, 0.3);  // [m]
const Shape kBox = Box{kHalfExtents};
const Shape kBall = Sphere{0.5};
const Shape kCapsule = Capsule{0.1, 0.4};

SphereContact findAtOrigin(const Vec3& p_W, const Shape& shape) {
  return findSphereContact(p_W, kRadius, shape, Vec3::Zero(), Quat::Identity());
}

void expectContact(const SphereContact& contact, double gap, const Vec3& n_W, const Vec3& p_W) {
  EXPECT_NEAR(contact.gap, gap, kRounding);
  EXPECT_NEAR((contact.n_W - n_W).norm(), 0.0, kRounding) << contact.n_W.transpose();
  EXPECT_NEAR((contact.p_W - p_W).norm(), 0.0, kRounding) << contact.p_W.transpose();
}

TEST(SphereOnBox, MeetsEachFaceAlongItsNormal) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      const Vec3 n = side * Vec3::Unit(axis);
      const Vec3 across = 0.05 * Vec3::Unit((axis + 1) % 3);  // away from the middle of the face
      const Vec3 on_face = kHalfExtents[axis] * n + across;
      expectContact(findAtOrigin(on_face + 0.04 * n, kBox), 0.03, n, on_face);
      expectContact(findAtOrigin(on_face + 0.004 * n, kBox), -0.006, n, on_face);
      expectContact(findAtOrigin(on_face, kBox), -kRadius, n, on_face);
      expectContact(findAtOrigin(on_face - 0.002 * n, kBox), -0.012, n, on_face);
    }
  }
}

TEST(SphereOnBox, MeetsEdgeAlongTheLineToIt) {
  const Vec3 edge(0.1, -0.2, 0.07);  // along z
  const Vec3 n(0.6, -0.8, 0.0);
  expectContact(findAtOrigin(edge + 0.05 * n, kBox), 0.04, n, edge);
  expectContact(findAtOrigin(edge + 0.005 * n, kBox), -0.005, n, edge);
}

TEST(SphereOnBox, MeetsCornerAlongTheLineToIt) {
  const Vec3 corner(-0.1, 0.2, -0.3);
  const Vec3 n = Vec3(-1.0, 2.0, -2.0) / 3.0;
  expectContact(findAtOrigin(corner + 0.03 * n, kBox), 0.02, n, corner);
  expectContact(findAtOrigin(corner + 0.003 * n, kBox), -0.007, n, corner);
}

TEST(SphereOnBox, LeavesFromInsideByTheNearestFace) {
  expectContact(findAtOrigin({0.08, 0.0, 0.0}, kBox), -0.03, Vec3::UnitX(), {0.1, 0.0, 0.0});
  expectContact(findAtOrigin({0.03, -0.17, 0.1}, kBox), -0.04, -Vec3::UnitY(), {0.03, -0.2, 0.1});
  expectContact(findAtOrigin({0.01, 0.1, 0.29}, kBox), -0.02, Vec3::UnitZ(), {0.01, 0.1, 0.3});
}

// All lengths are powers of two, so the distances to two faces are exactly equal.
TEST(SphereOnBox, TiesGoToTheFirstAxisAndThePositiveSide) {
  const Shape cube = Box{Vec3(0.5, 0.5, 0.5)};
  expectContact(findAtOrigin(Vec3::Zero(), cube), -0.51, Vec3::UnitX(), {0.5, 0.0, 0.0});
  expectContact(findAtOrigin({-0.0, 0.25, -0.0}, cube), -0.26, Vec3::UnitY(), {0.0, 0.5, 0.0});
  expectContact(findAtOrigin({-0.25, 0.25, 0.25}, cube), -0.26, -Vec3::UnitX(), {-0.5, 0.25, 0.25});
  expectContact(findAtOrigin({0.0, -0.25, 0.25}, cube), -0.26, -Vec3::UnitY(), {0.0, -0.5, 0.25});
  expectContact(findAtOrigin({0.5, 0.5, 0.5}, cube), -kRadius, Vec3::UnitX(), {0.5, 0.5, 0.5});
}

// The point is so near to an edge that the square of its distance underflows.
TEST(SphereOnBox, NormalSurvivesUnderflow) {
  for (const double tiny : {1e-161, 1e-200}) {
    const Shape needle = Box{Vec3(tiny, tiny, 1.0)};
    const SphereContact contact = findAtOrigin({2.0 * tiny, 2.0 * tiny, 0.0}, needle);
    expectContact(contact, -kRadius, Vec3::UnitX(), Vec3::Zero());
  }
}

TEST(SphereOnSphere, MeetsOnTheLineOfCentres) {
  const Vec3 n = Vec3(2.0, -1.0, 2.0) / 3.0;
  expectContact(findAtOrigin(0.6 * n, kBall), 0.09, n, 0.5 * n);
  expectContact(findAtOrigin(0.505 * n, kBall), -0.005, n, 0.5 * n);
  expectContact(findAtOrigin(0.2 * n, kBall), -0.31, n, 0.5 * n);
}

TEST(SphereOnSphere, LeavesFromTheCentreAlongTheBodysX) {
  expectContact(findAtOrigin(Vec3::Zero(), kBall), -0.51, Vec3::UnitX(), {0.5, 0.0, 0.0});
  const Quat turned(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  const Vec3 centre(1.0, 2.0, 3.0);
  const Vec3 n = turned * Vec3::UnitX();
  expectContact(findSphereContact(centre, kRadius, kBall, centre, turned), -0.51, n,
                centre + 0.5 * n);
}

TEST(SphereOnCapsule, MeetsSideAcrossTheAxis) {
  const Vec3 n(0.6, 0.0, -0.8);
  const Vec3 core(0.0, 0.3, 0.0);
  expectContact(findAtOrigin(core + 0.15 * n, kCapsule), 0.04, n, core + 0.1 * n);
  expectContact(findAtOrigin(core + 0.02 * n, kCapsule), -0.09, n, core + 0.1 * n);
}

TEST(SphereOnCapsule, MeetsCapsAsSpheres) {
  const Vec3 end(0.0, -0.4, 0.0);
  const Vec3 n = Vec3(2.0, -2.0, 1.0) / 3.0;
  expectContact(findAtOrigin(end + 0.15 * n, kCapsule), 0.04, n, end + 0.1 * n);
  expectContact(findAtOrigin({0.0, 0.7, 0.0}, kCapsule), 0.19, Vec3::UnitY(), {0.0, 0.5, 0.0});
}

TEST(SphereOnCapsule, LeavesFromTheCoreAcrossTheAxis) {
  for (const double y : {-0.4, -0.1, 0.0, 0.4})
    expectContact(findAtOrigin({0.0, y, 0.0}, kCapsule), -0.11, Vec3::UnitX(), {0.1, y, 0.0});
}

// Turning the core into the world and back leaves rounding errors. These must not become a normal.
TEST(SphereOnCapsule, RoundingIsNoDirectionToLeaveBy) {
  const Quat turned(Eigen::AngleAxisd(1.1, Vec3(1.0, 2.0, 3.0).normalized()));
  const Vec3 p_WB(0.3, -0.7, 0.9);
  for (int i = -40; i <= 40; ++i) {
    const Vec3 on_core = p_WB + turned * Vec3(0.0, 0.01 * i, 0.0);
    const SphereContact contact = findSphereContact(on_core, kRadius, kCapsule, p_WB, turned);
    const Vec3 n = turned * Vec3::UnitX();
    expectContact(contact, -0.11, n, on_core + 0.1 * n);
  }
}

TEST(SphereOnCapsule, WithoutLengthIsASphere) {
  const Shape capsule = Capsule{0.5, 0.0};
  for (const Vec3& p : {Vec3(0.4, 0.5, -0.6), Vec3(0.1, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)}) {
    const SphereContact ball = findAtOrigin(p, kBall);
    expectContact(findAtOrigin(p, capsule), ball.gap, ball.n_W, ball.p_W);
  }
}

TEST(SphereOnPlane, GapIsHeightAboveIt) {
  const Vec3 n(0.0, 0.6, 0.8);
  const Shape plane = Plane{n, 0.25};
  const Vec3 foot = 0.25 * n + Vec3(3.0, 0.8, -0.6);  // on the plane, far from its origin
  expectContact(findAtOrigin(foot + 0.5 * n, plane), 0.49, n, foot);
  expectContact(findAtOrigin(foot, plane), -kRadius, n, foot);
  expectContact(findAtOrigin(foot - 2.0 * n, plane), -2.01, n, foot);
}

// checkShape() accepts a normal that is unit only in single precision.
TEST(SphereOnPlane, NormalIsUnitForOneThatNearlyIs) {
  const Vec3 n(0.0, 0.6, 0.8);
  const Shape plane =
      Plane{(1.0 + 5e-7) * n, (1.0 + 5e-7) * 0.25};  // describes the same half-space
  expectContact(findAtOrigin(0.75 * n, plane), 0.49, n, 0.25 * n);
}

// In the middle of a box all faces are about equally far. With rounding each may find another to be
// nearer; still one must push.
TEST(SphereOnMesh, MiddleOfABoxIsPushedByAFace) {
  constexpr std::uint64_t kSeed = 20260309;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    const double half = random.logUniform(1e-6, 1e3);  // [m]
    const Shape box = test::makeMesh(
        test::cutIntoTriangles(test::makeBoxSolid(Vec3::Constant(half) + random.inCube(1e-12))));
    const Vec3 middle = random.inCube(i % 2 == 0 ? 1e-12 : 1e-13 * half);
    const SphereContact contact =
        findSphereContact(middle, kRadius, box, Vec3::Zero(), Quat::Identity());
    ASSERT_NEAR(contact.gap, -half - kRadius, 1e-11 + 1e-13 * half) << half;
  }
}

// A quarter turn about z puts the capsule along -x; an eighth puts the box on its edge.
TEST(SphereContact, FollowsThePoseOfTheBody) {
  const Vec3 p_WB(1.0, -2.0, 0.5);
  const Quat quarter(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
  const Vec3 beyond_end = p_WB + Vec3(-0.6, 0.0, 0.0);
  expectContact(findSphereContact(beyond_end, kRadius, kCapsule, p_WB, quarter), 0.09,
                -Vec3::UnitX(), p_WB + Vec3(-0.5, 0.0, 0.0));

  const Quat eighth(Eigen::AngleAxisd(kPi / 4, Vec3::UnitZ()));
  const Shape cube = Box{Vec3(0.1, 0.1, 0.1)};
  const Vec3 top = p_WB + Vec3(0.0, std::sqrt(0.02), 0.05);
  expectContact(findSphereContact(top + Vec3(0.0, 0.02, 0.0), kRadius, cube, p_WB, eighth), 0.01,
                Vec3::UnitY(), top);
}

TEST(SphereContact, NormalIsUnitForQuaternionThatNearlyIs) {
  Quat q(Eigen::AngleAxisd(0.7, Vec3(3.0, -1.0, 2.0).normalized()));
  const SphereContact exact = findSphereContact({1, 1, 1}, kRadius, kBox, Vec3::Zero(), q);
  q.coeffs() *= 1.0 + 1e-6;
  const SphereContact contact = findSphereContact({1, 1, 1}, kRadius, kBox, Vec3::Zero(), q);
  expectContact(contact, exact.gap, exact.n_W, exact.p_W);
  EXPECT_NEAR(contact.n_W.norm(), 1.0, 1e-15);
}

TEST(SphereContact, PointHasTheGapOfASphereWithoutRadius) {
  const Vec3 p(0.4, 0.1, -0.2);
  for (const Shape& shape : {kBall, kBox, kCapsule, Shape(Plane{})}) {
    const SphereContact point = findSphereContact(p, 0.0, shape, Vec3::Zero(), Quat::Identity());
    expectContact(findAtOrigin(p, shape), point.gap - kRadius, point.n_W, point.p_W);
  }
}

}  // namespace
}  // namespace tandem
