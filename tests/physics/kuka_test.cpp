// A robot with the links of a KUKA LBR iiwa, led by its motors, pushes a cube over a floor.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;
using test::ArmLinkPlan;

constexpr double kHalf = 0.025;                  // of the cube [m]
constexpr double kToolLength = 0.12;             // [m]
constexpr double kSpeed = 0.1, kPush = 0.075;    // [m/s, m]
constexpr double kStart = 0.5, kGap = 0.005;     // the tool's face, and from there to the cube [m]
constexpr double kToolHalf = 0.01, kTip = 0.01;  // [m]; height of the tool's tip over the floor
constexpr double kForce = 300.0;                 // of each motor at most [N m]

// Heights of the joints in the straight pose [m]. Joints 2, 4 and 6 turn about y, the others about
// z.
constexpr double kJoint[] = {0.1575, 0.36, 0.5645, 0.78, 0.9645, 1.18, 1.261};
constexpr double kCentre[] = {0.12, 0.059, 0.13, 0.067, 0.076, 0.0004, 0.02 + 0.5 * kToolLength};
constexpr double kMasses[] = {4.0, 4.0, 3.0, 2.7, 1.7, 1.8, 0.3};

std::vector<ArmLinkPlan> makeKuka() {
  std::vector<ArmLinkPlan> plan(std::size(kJoint));
  for (std::size_t i = 0; i < plan.size(); ++i) {
    const double parent = i == 0 ? 0.0 : kJoint[i - 1] + kCentre[i - 1];
    plan[i].axis = i % 2 == 0 ? Vec3::UnitZ() : Vec3::UnitY();
    plan[i].mass = kMasses[i];
    plan[i].half = Vec3(0.04, 0.04, 0.06);
    plan[i].e = Vec3(0.0, 0.0, kJoint[i] - parent);
    plan[i].d = Vec3(0.0, 0.0, kCentre[i]);
  }
  plan.back().half = Vec3(kToolHalf, 0.02, 0.5 * kToolLength);
  return plan;
}

/// Angles of the joints with which the tool hangs down over `x` [rad].
std::vector<double> reach(double x) {
  const double upper = kJoint[3] - kJoint[1], lower = kJoint[5] - kJoint[3];
  const double tool = kJoint[6] + kCentre[6] + 0.5 * kToolLength - kJoint[5];
  const double z = kTip + tool - kJoint[1];
  const double way = std::hypot(x, z);
  const double lift = std::acos((upper * upper + way * way - lower * lower) / (2.0 * upper * way));
  const double first = std::atan2(x, z) - lift;
  const double second = std::atan2(x - upper * std::sin(first), z - upper * std::cos(first));
  return {0.0, first, 0.0, second - first, 0.0, M_PI - second, 0.0};
}

struct Push {
  double way, overlap;  ///< of the cube; of tool and cube at most [m]
};

Push push(double rate, bool has_site) {
  ArmHost host;
  host.build(makeKuka());
  const auto angles = reach(kStart - kToolHalf);
  for (std::size_t i = 0; i < angles.size(); ++i)
    host.arm().setJointPos(static_cast<int>(i), static_cast<btScalar>(angles[i]));
  host.showPose();
  std::vector<btMultiBodyJointMotor*> motors;
  for (std::size_t i = 0; i < angles.size(); ++i)
    motors.push_back(&host.addMotor(static_cast<int>(i), 0.0, kForce / rate));
  host.host.addBody(host.host.makeBox(Vec3(2, 2, 0.1)), 0.0, Vec3(0, 0, -0.1));
  const double face = kStart + kGap;
  btRigidBody& cube = host.host.addBody(host.host.makeBox(Vec3::Constant(kHalf)), 0.2,
                                        Vec3(face + kHalf, 0.0, kHalf));
  cube.setSleepingThresholds(0, 0);
  if (has_site) {
    SiteSettings settings;
    settings.peers = 1;
    host.start(settings);
    host.site->share(cube);
  }
  Push result{0.0, 0.0};
  const int steps = static_cast<int>(std::lround((kGap + kPush) / kSpeed * rate));
  for (int step = 1; step <= steps; ++step) {
    const double tool = kStart - kToolHalf + kSpeed * step / rate;
    const auto wanted = reach(tool);
    for (std::size_t i = 0; i < motors.size(); ++i) {
      const int link = static_cast<int>(i);
      const double speed = (wanted[i] - host.q(link)) * rate;
      motors[i]->setVelocityTarget(static_cast<btScalar>(speed));
    }
    host.step(1.0 / rate);
    const double cube_face = fromBullet(cube.getCenterOfMassPosition()).x() - kHalf;
    result.overlap = std::max(result.overlap, host.linkPosition(6).x() + kToolHalf - cube_face);
    result.way = cube_face - face;
  }
  return result;
}

TEST(Kuka, PushesASharedCubeAsFarAsAnyOther) {
  for (const double rate : {60.0, 240.0}) {
    const Push bare = push(rate, false), shared = push(rate, true);
    EXPECT_NEAR(bare.way, kPush, 2e-3) << rate << " Hz";
    EXPECT_NEAR(shared.way, kPush, 1e-4) << rate << " Hz";
    EXPECT_LT(shared.overlap, std::max(1.5 * bare.overlap, 1e-5)) << rate << " Hz";
  }
}

}  // namespace
}  // namespace tandem
