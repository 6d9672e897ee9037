#include "falcon/src/novint/falcon_kinematics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

const Vec3 kMiddle(0.0, 0.0, 0.125);

struct Known {
  Vec3 p_D, angles, counts;
  Eigen::Matrix3d dangles_dp;
};

Eigen::Matrix3d rows(const Vec3& a, const Vec3& b, const Vec3& c) {
  Eigen::Matrix3d m;
  m << a.transpose(), b.transpose(), c.transpose();
  return m;
}

// Known values from an independent solution of the same geometry; angles to 1e-6 rad, slopes to
// 1e-3 rad/m.
const std::array<Known, 5> kKnown = {{
    {{0, 0, 0.125},
     Vec3::Constant(0.483618),
     Vec3::Constant(-200),
     rows({3.076, -10.255, 13.205}, {-10.419, 2.464, 13.205}, {7.343, 7.791, 13.205})},
    {{0.02, -0.01, 0.13},
     {0.739574, 0.350136, 0.654933},
     {202, -410, 69},
     rows({5.943, -10.268, 12.109}, {-8.105, 1.081, 14.782}, {9.951, 5.425, 12.665})},
    {{-0.03, 0.025, 0.11},
     {-0.009661, 0.778355, 0.392536},
     {-976, 263, -343},
     rows({-1.585, -8.837, 16.746}, {-13.154, 6.043, 9.336}, {2.881, 13.710, 13.182})},
    {{0.04, 0.04, 0.14},
     {0.677287, 0.641513, 1.356998},
     {104, 48, 1173},
     rows({11.328, -4.040, 15.891}, {-4.314, 10.321, 15.695}, {9.917, 10.416, 12.331})},
    {{-0.045, -0.03, 0.12},
     {0.834836, 1.015090, 0.001725},
     {352, 636, -958},
     rows({-5.643, -14.286, 11.204}, {-14.942, -3.893, 9.973}, {1.695, 4.698, 16.659})},
}};

TEST(FalconKinematics, KnownPositions) {
  const FalconKinematics kinematics;
  for (const Known& known : kKnown) {
    SCOPED_TRACE(::testing::Message() << known.p_D.transpose());
    const auto pose = kinematics.computePose(known.p_D);
    ASSERT_TRUE(pose);
    EXPECT_LT((pose->angles - known.angles).cwiseAbs().maxCoeff(), 6e-7);
    EXPECT_LT((pose->dangles_dp - known.dangles_dp).cwiseAbs().maxCoeff(), 6e-4);
    for (Eigen::Index i = 0; i < 3; ++i)
      EXPECT_EQ(std::lround(countsOfAngle(pose->angles[i])), std::lround(known.counts[i]));
  }
  for (const auto& [z, angle, counts] :
       {std::tuple{0.09, -0.018413, -990}, {0.165, 1.066966, 717}}) {
    const auto angles = kinematics.computeAngles(Vec3(0, 0, z));
    ASSERT_TRUE(angles);
    for (Eigen::Index i = 0; i < 3; ++i) {
      EXPECT_NEAR((*angles)[i], angle, 6e-7);
      EXPECT_EQ(std::lround(countsOfAngle((*angles)[i])), counts);
    }
  }
}

/// Draws a position in reach, in a cube of 10 cm around the middle.
FalconPose drawPose(test::Random& random, const FalconKinematics& kinematics, double half = 0.05) {
  for (;;) {
    const auto pose = kinematics.computePose(Vec3(kMiddle + random.inCube(half)));
    if (pose) return *pose;
  }
}

TEST(FalconKinematics, ForwardUndoesInverse) {
  constexpr std::uint64_t kSeed = 50;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconKinematics kinematics;
  double worst = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const FalconPose pose = drawPose(random, kinematics);
    const auto back = kinematics.computePoseOfAngles(pose.angles);
    ASSERT_TRUE(back) << pose.p_D.transpose();
    worst = std::max(worst, (back->p_D - pose.p_D).norm());
  }
  EXPECT_LT(worst, 1e-12);
}

TEST(FalconKinematics, SlopesAreThoseOfTheAngles) {
  constexpr std::uint64_t kSeed = 51;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconKinematics kinematics;
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    const FalconPose pose = drawPose(random, kinematics, 0.03);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto after = kinematics.computeAngles(pose.p_D + kStep * Vec3::Unit(axis));
      const auto before = kinematics.computeAngles(pose.p_D - kStep * Vec3::Unit(axis));
      ASSERT_TRUE(after && before);
      const Vec3 slope = (*after - *before) / (2.0 * kStep);
      ASSERT_LT((slope - pose.dangles_dp.col(axis)).norm(), 1e-6);
    }
  }
}

TEST(FalconKinematics, MotorsDoTheWorkOfTheForce) {
  constexpr std::uint64_t kSeed = 52;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconKinematics kinematics;
  for (int i = 0; i < 10000; ++i) {
    const FalconPose pose = drawPose(random, kinematics);
    const Vec3 f_D = random.inCube(8.0), step_D = random.inCube(1e-3);
    const auto torques = computeTorques(pose, f_D);
    ASSERT_TRUE(torques);
    ASSERT_NEAR(torques->dot(pose.dangles_dp * step_D), f_D.dot(step_D), 1e-10 * 8.0);
  }
}

// Rounds a force to whole motor commands, at positions in a cube of 6 cm.
TEST(FalconKinematics, CommandsKeepDirectionAndSize) {
  constexpr std::uint64_t kSeed = 53;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const FalconKinematics kinematics;
  double worst_angle = 0.0, worst_size = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const FalconPose pose = drawPose(random, kinematics, 0.03);
    const Vec3 f_D = 5.0 * random.direction();
    const auto torques = computeTorques(pose, f_D);
    ASSERT_TRUE(torques);
    const FalconMotors motors = makeMotorCommands(*torques);
    Vec3 made;
    for (std::size_t k = 0; k < 3; ++k)
      made[static_cast<Eigen::Index>(k)] = -motors[k] / kUsualMotorsPerTorque;
    const Vec3 rendered_D = pose.dangles_dp.transpose() * made;
    worst_angle =
        std::max(worst_angle, std::atan2(rendered_D.cross(f_D).norm(), rendered_D.dot(f_D)));
    worst_size = std::max(worst_size, std::abs(rendered_D.norm() / 5.0 - 1.0));
  }
  EXPECT_LT(worst_angle * 180.0 / 3.14159265358979323846, 0.1);
  EXPECT_LT(worst_size, 0.005);
}

TEST(FalconKinematics, CommandsNeverWrap) {
  constexpr std::uint64_t kSeed = 54;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 torques = random.direction() * random.logUniform(1e-6, 1e300);
    const FalconMotors motors = makeMotorCommands(torques);
    const double scale =
        std::min(1.0, 4095.0 / (kUsualMotorsPerTorque * torques.cwiseAbs().maxCoeff()));
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_LE(std::abs(motors[k]), kMostMotor);
      // The error is half a step of rounding. The direction is kept: no motor is clipped alone.
      ASSERT_NEAR(motors[k], -kUsualMotorsPerTorque * scale * torques[static_cast<Eigen::Index>(k)],
                  0.5 + 1e-9);
    }
  }
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {inf, -inf, std::nan("")})
    EXPECT_EQ(makeMotorCommands(Vec3(0.1, bad, 0.0)), FalconMotors{});
  EXPECT_EQ(makeMotorCommands(Vec3(0.1, 0.0, 0.0), std::nan("")), FalconMotors{});
  EXPECT_EQ(makeMotorCommands(Vec3(1e308, -1e308, 0.0)), (FalconMotors{-4095, 4095, 0}));
}

TEST(FalconKinematics, OutOfReachIsNothing) {
  const FalconKinematics kinematics;
  const double nan = std::nan("");
  for (const Vec3& p_D : {Vec3(0.3, 0, 0.125), Vec3(0, 0, 0.3), Vec3(0, -0.2, 0.1),
                          Vec3(nan, 0, 0.1), Vec3(0, 0, std::numeric_limits<double>::infinity())})
    EXPECT_FALSE(kinematics.computePose(p_D)) << p_D.transpose();
  EXPECT_FALSE(kinematics.computePoseOfAngles(FalconAngles(nan, 0, 0), kMiddle));
  EXPECT_FALSE(kinematics.computePoseOfAngles(FalconAngles(3.1, -3.1, 3.1), kMiddle));
}

TEST(FalconKinematics, CountsAndAnglesAreTheSame) {
  EXPECT_NEAR(countsOfAngle(angleOfCounts(-2047.0)), -2047.0, 1e-9);
  EXPECT_NEAR(1.0 / (angleOfCounts(1.0) - angleOfCounts(0.0)), 1572.563, 5e-4);
}

}  // namespace
}  // namespace tandem
