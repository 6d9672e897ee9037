#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"

namespace tandem {
namespace {

using test::byWidth;
using test::ObstacleScene;

constexpr double kFriction = 0.3;  // friction of the floor; the cube's is 1, and Bullet multiplies
constexpr double kHold = kFriction * ObstacleScene::kMass * ObstacleScene::kGravity;  // mu m g [N]

struct Floor {
  const char* name;
  bool is_plane;
  double inner_rate;  // [Hz]
  double far;         // distance of the scene from the world's origin [m]
};

class ObstacleFloor : public ::testing::TestWithParam<Floor> {
 protected:
  ObstacleFloor() : scene(GetParam().far * Vec3(0.6, -0.48, 0.64)) {
    if (GetParam().is_plane) {
      scene.addPlane(kFriction);
    } else {
      scene.addBoxFloor(kFriction);
    }
    scene.start(Vec3(0, ObstacleScene::kHalf, 0));
  }
  [[nodiscard]] double dt() const { return 1.0 / GetParam().inner_rate; }
  [[nodiscard]] static Vec3 along(double angle) { return {std::cos(angle), 0, std::sin(angle)}; }
  /// Rounding of the places at which a float host can put floor and cube.
  [[nodiscard]] static double placement() { return GetParam().far * byWidth(1e-15, 1e-7); }
  ObstacleScene scene;
};

TEST_P(ObstacleFloor, HoldsACubeAtRestWithoutCreepOrBounce) {
  const Vec3 start = scene.position();
  double highest = -1, lowest = 1, fastest = 0;
  scene.run(2.0, dt(), Vec3::Zero(), [&] {
    highest = std::max(highest, scene.position().y() - start.y());
    lowest = std::min(lowest, scene.position().y() - start.y());
    fastest = std::max(fastest, scene.state.v_W.norm());
  });
  // Decimetres from its origin a float Bullet resolves the gap to some nanometres. Per step this is
  // a velocity.
  const double resolution = byWidth(1e-10, 1e-7);
  EXPECT_LT(highest, resolution + placement());
  EXPECT_GT(lowest, -resolution - placement());
  // The cube may creep sideways at the residual of the solved rows: 1e-9 m/s, in float 1e-7 m/s.
  EXPECT_LT((scene.position() - start).norm(), byWidth(2e-9, 2e-7) + 2 * placement());
  // A gap error of half a unit of a metre-sized coordinate gives that distance per step as speed.
  EXPECT_LT(fastest, byWidth(1e-8, 1e-6) + (byWidth(0, 5e-8) + placement()) / dt());
  EXPECT_LT(scene.state.q_WB.angularDistance(Quat::Identity()), byWidth(1e-7, 1e-5));
}

TEST_P(ObstacleFloor, HoldsByStictionBelowTheLimit) {
  for (const double angle : {0.0, 0.3, M_PI / 4}) {
    const Vec3 start = scene.position();
    scene.run(0.5, dt(), 0.98 * kHold * along(angle));
    // The first steps of a new direction settle; then the cube may creep as above.
    EXPECT_LT((scene.position() - start).norm(), byWidth(1e-7, 1e-6) + 2 * placement())
        << "angle " << angle;
  }
}

TEST_P(ObstacleFloor, SlidesWithCoulombFrictionAboveTheLimit) {
  for (const double angle : {0.0, 0.3, M_PI / 4}) {
    for (const double push : {1.05 * kHold, 2.0 * kHold}) {
      const Vec3 force = push * along(angle);
      const RigidState rest = scene.state;
      scene.run(0.5, dt(), force);
      const double expected = (push - kHold) / ObstacleScene::kMass * 0.5;
      EXPECT_NEAR(scene.state.v_W.dot(along(angle)), expected, 0.02 * expected)
          << "angle " << angle << " push " << push;
      EXPECT_NEAR(scene.position().y(), ObstacleScene::kHalf, 20e-6);
      EXPECT_LT(scene.state.w_W.norm(), 0.01);
      scene.state = rest;
    }
  }
}

TEST_P(ObstacleFloor, BrakesASlidingCubeToRest) {
  scene.state.v_W = Vec3(0.2, 0, 0.1);
  const double speed = scene.state.v_W.norm();
  const double stopping = speed * speed / (2 * kFriction * ObstacleScene::kGravity);
  const Vec3 start = scene.position();
  scene.run(0.3, dt());
  EXPECT_LT(scene.state.v_W.norm(), byWidth(1e-7, 1e-5) + (byWidth(0, 5e-8) + placement()) / dt());
  // The last step stops within itself. The error is at most mu g dt^2 per step; two per cent cover
  // it.
  EXPECT_NEAR((scene.position() - start).norm(), stopping, 0.02 * stopping + speed * dt());
}

INSTANTIATE_TEST_SUITE_P(Floors, ObstacleFloor,
                         ::testing::Values(Floor{"Plane4kHz", true, 4000, 0},
                                           Floor{"Box4kHz", false, 4000, 0},
                                           Floor{"Plane1kHz", true, 1000, 0},
                                           Floor{"Box1kHz", false, 1000, 0},
                                           Floor{"PlaneFarAway", true, 4000, byWidth(1000, 10)},
                                           Floor{"BoxFarAway", false, 4000, byWidth(1000, 10)}),
                         [](const auto& floor) { return std::string(floor.param.name); });

}  // namespace
}  // namespace tandem
