#include "reference/spatial_cooperation.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include <gtest/gtest.h>

#include "bench/reference/paper_reference.h"

namespace tandem::reference {
namespace {

// Contacts begin and end inside steps of 5 us here and of 2 us in the paper model. Each costs up to
// 5e-8 m (see PaperModel.ConvergesWithTheStep). A contact multiplies the sum by K.
constexpr double kPositionTolerance = 5e-7;                      // [m]
constexpr double kForceTolerance = 4000.0 * kPositionTolerance;  // [N]

SpatialParameters makeOffCentre() {
  SpatialParameters parameters;
  parameters.sampling.duration = 0.3;
  parameters.step = 2e-5;
  parameters.hand_force = {Vec3(5.0, 0.3, 0.0), Vec3(-1.0, 0.0, 0.2)};
  parameters.start_offset = {Vec3(0.0, 0.008, 0.0), Vec3(0.0, -0.005, 0.003)};
  return parameters;
}

class SpatialHip : public ::testing::TestWithParam<HipMotion> {};
INSTANTIATE_TEST_SUITE_P(Motions, SpatialHip,
                         ::testing::Values(HipMotion::kExtrapolated, HipMotion::kContinuous));

TEST_P(SpatialHip, AxialForcesGiveThePaperModel) {
  PaperParameters on_axis = makeCooperativeManipulation(Scheme::kRemoteDynamicProxy);
  on_axis.hip_motion = GetParam();
  SpatialParameters in_space;
  in_space.hip_motion = GetParam();
  const PaperResult paper = runPaperModel(on_axis);
  const SpatialResult spatial = runSpatialCooperation(in_space);

  ASSERT_EQ(paper.rows.size(), spatial.rows.size());
  const double start_1 = computeStart(in_space, 0).x();
  const double start_2 = computeStart(in_space, 1).x();
  for (std::size_t k = 0; k < paper.rows.size(); ++k) {
    SCOPED_TRACE(k);
    const PaperRow& a = paper.rows[k];
    const SpatialSite& site_1 = spatial.rows[k].site[0];
    const SpatialSite& site_2 = spatial.rows[k].site[1];
    ASSERT_EQ(a.t, spatial.rows[k].t);
    ASSERT_NEAR(a.x1, site_1.device_p.x() - start_1, kPositionTolerance);
    ASSERT_NEAR(a.x2, site_2.device_p.x() - start_2, kPositionTolerance);
    ASSERT_NEAR(a.xo1, site_1.box_p.x(), kPositionTolerance);
    ASSERT_NEAR(a.xo2, site_2.box_p.x(), kPositionTolerance);
    ASSERT_NEAR(a.x21, site_1.proxy_p.x() - start_2, kPositionTolerance);
    ASSERT_NEAR(a.x12, site_2.proxy_p.x() - start_1, kPositionTolerance);
    ASSERT_NEAR(a.force_1, site_1.force.x(), kForceTolerance);
    ASSERT_NEAR(a.force_2, site_2.force.x(), kForceTolerance);
    // All motion stays on the axis.
    ASSERT_EQ(site_1.box_p.tail<2>().norm() + site_2.box_p.tail<2>().norm(), 0.0);
    ASSERT_EQ(site_1.box_q.vec().norm() + site_2.box_q.vec().norm(), 0.0);
  }
  EXPECT_NEAR(paper.summary.device_end[0], spatial.end.site[0].device_p.x() - start_1,
              kPositionTolerance);
  EXPECT_NEAR(spatial.end.t, 1.0, 1e-12);
}

TEST(SpatialCooperation, OffCentrePushTurnsBothCopies) {
  const SpatialResult result = runSpatialCooperation(makeOffCentre());
  // User 1 pushes along +x above the centre (+y). The cube turns about -z, first at site 1.
  const Vec3 early = computeRotationVector(Quat::Identity(), result.rows[45].site[0].box_q);
  EXPECT_LT(early.z(), -0.01);
  for (const SpatialSite& site : result.end.site) {
    EXPECT_GT(computeRotationVector(Quat::Identity(), site.box_q).norm(), 0.05);
  }
}

// Coordination acts only on the difference of the two rotations. It keeps the copies together and
// lets them turn together.
TEST(SpatialCooperation, AngularCoordinationKeepsCopiesTogether) {
  const auto turnOf = [](const SpatialRow& row, std::size_t site) {
    return computeRotationVector(Quat::Identity(), row.site[site].box_q).norm();
  };
  const auto differenceIn = [](const SpatialRow& row) {
    return computeRotationVector(row.site[0].box_q, row.site[1].box_q).norm();
  };
  SpatialParameters parameters = makeOffCentre();
  const SpatialRow coordinated = runSpatialCooperation(parameters).end;
  parameters.angular_coordination = SpringDamper{};
  const SpatialRow separate = runSpatialCooperation(parameters).end;
  EXPECT_LT(differenceIn(coordinated), 0.8 * differenceIn(separate));
  EXPECT_LT(differenceIn(coordinated), 0.25 * turnOf(coordinated, 0));
  EXPECT_LT(differenceIn(coordinated), 0.25 * turnOf(coordinated, 1));
}

TEST(SpatialCooperation, TurnsWithTheScene) {
  // A quarter turn about x maps the cube onto itself, so it maps the run onto a turned run.
  const Quat turn(Eigen::AngleAxisd(std::numbers::pi / 2.0, Vec3::UnitX()));
  const SpatialParameters upright = makeOffCentre();
  SpatialParameters turned = upright;
  for (std::size_t user = 0; user < 2; ++user) {
    turned.hand_force[user] = turn * upright.hand_force[user];
    turned.start_offset[user] = turn * upright.start_offset[user];
  }
  const SpatialResult a = runSpatialCooperation(upright);
  const SpatialResult b = runSpatialCooperation(turned);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_LE((turn * a.end.site[s].device_p - b.end.site[s].device_p).norm(), 1e-9);
    EXPECT_LE((turn * a.end.site[s].box_p - b.end.site[s].box_p).norm(), 1e-9);
    const Quat expected = turn * a.end.site[s].box_q * turn.conjugate();
    EXPECT_LE(computeRotationVector(expected, b.end.site[s].box_q).norm(), 1e-7);
  }
}

TEST(SpatialCooperation, ConvergesWithTheStep) {
  SpatialParameters parameters = makeOffCentre();
  const SpatialResult coarse = runSpatialCooperation(parameters);
  parameters.step /= 4.0;
  const SpatialResult fine = runSpatialCooperation(parameters);
  constexpr double kLever = 5e-3;  // shortest arm of the pushes that turn the cube [m]
  for (std::size_t k = 0; k < fine.rows.size(); ++k) {
    for (std::size_t s = 0; s < 2; ++s) {
      const SpatialSite& a = fine.rows[k].site[s];
      const SpatialSite& b = coarse.rows[k].site[s];
      ASSERT_LE((a.device_p - b.device_p).norm(), kPositionTolerance) << "tick " << k;
      ASSERT_LE((a.box_p - b.box_p).norm(), kPositionTolerance) << "tick " << k;
      ASSERT_LE(computeRotationVector(a.box_q, b.box_q).norm(), kPositionTolerance / kLever)
          << "tick " << k;
    }
  }
}

// The default gives the relative rotation the eigenvalues of the relative translation.
TEST(SpatialCooperation, AngularGainsScaleWithInertiaOverMass) {
  SpatialParameters parameters;
  const Box copy = makeUniformBox(Vec3::Constant(parameters.object_size), 0.1);
  const SpringDamper gains = computeAngularCoordination(parameters);
  EXPECT_NEAR(gains.stiffness / copy.inertia.x(), 200.0 / 0.1, 1e-9);
  EXPECT_NEAR(gains.damping / copy.inertia.x(), 30.0 / 0.1, 1e-9);
  parameters.angular_coordination = SpringDamper{};
  EXPECT_EQ(computeAngularCoordination(parameters).stiffness, 0.0);
}

TEST(SpatialCooperation, HipAndProxyPushEachOtherAtEachSite) {
  SpatialParameters parameters;
  parameters.sampling.duration = 0.3;
  parameters.step = 2e-5;
  // Both users miss the cube and drive at each other above it.
  const Vec3 above(0.0, 0.05, 0.0);
  parameters.start_offset = {above, above};
  parameters.hand_force = {Vec3(3.0, 0.0, 0.0), Vec3(-3.0, 0.0, 0.0)};
  const SpatialResult result = runSpatialCooperation(parameters);
  double force_1 = 0.0;
  double force_2 = 0.0;
  for (const SpatialRow& row : result.rows) {
    force_1 = std::min(force_1, row.site[0].force.x());
    force_2 = std::max(force_2, row.site[1].force.x());
    ASSERT_EQ(row.site[0].box_p.norm(), 0.0);
    // The users are mirror images.
    ASSERT_NEAR(row.site[0].device_p.x(), -row.site[1].device_p.x(), 1e-12);
  }
  EXPECT_LT(force_1, -1.0);
  EXPECT_GT(force_2, 1.0);
}

}  // namespace
}  // namespace tandem::reference
