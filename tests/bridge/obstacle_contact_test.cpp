#include <cmath>

#include <gtest/gtest.h>

#include "bridge/obstacle_scene.h"
#include "coordination/src/geometry/triangle_mesh.h"

namespace tandem {
namespace {

using test::byWidth;
using test::ObstacleScene;

struct Impact {
  bool is_plane;
  double speed;  // [m/s]
};
class ObstacleImpact : public ::testing::TestWithParam<Impact> {
 protected:
  /// A wall at x = 0 whose free side is -x, and a cube that flies at it from distance `gap`.
  void fly(double gap, double restitution) {
    scene.weightless = true;
    btCollisionShape& shape =
        GetParam().is_plane
            ? static_cast<btCollisionShape&>(
                  scene.rig.makeShape<btStaticPlaneShape>(btVector3(-1, 0, 0), btScalar(0)))
            : scene.rig.makeShape<btBoxShape>(btVector3(btScalar(0.1), 1, 1));
    btRigidBody& wall = scene.addObstacle(shape, 0.5, Vec3(GetParam().is_plane ? 0.0 : 0.1, 0, 0));
    wall.setRestitution(1);
    scene.start(Vec3(-ObstacleScene::kHalf - gap, 0.005, 0.003), Quat::Identity(), restitution);
    scene.state.v_W = Vec3(GetParam().speed, 0, 0);
  }
  [[nodiscard]] double gap() const { return -scene.position().x() - ObstacleScene::kHalf; }
  ObstacleScene scene;
  static constexpr double kStep = 1.0 / 4000.0;
};

// At any phase of the impact in the step the cube stops at the wall, without overlap or rebound.
TEST_P(ObstacleImpact, StopsAtTheWallWithoutABounce) {
  for (int phase = 0; phase < 10; ++phase) {
    ObstacleScene& s = scene;
    if (phase == 0) fly(1e-3, 0.0);
    s.state.p_W =
        Vec3(-ObstacleScene::kHalf - 1e-3 - 0.1 * phase * GetParam().speed * kStep, 0.005, 0.003);
    s.state.v_W = Vec3(GetParam().speed, 0, 0);
    s.state.w_W.setZero();
    s.state.q_WB.setIdentity();
    double deepest = 1;
    s.run(1e-3 / GetParam().speed + 20 * kStep, kStep, Vec3::Zero(),
          [&] { deepest = std::min(deepest, gap()); });
    EXPECT_LT(std::abs(s.state.v_W.x()), byWidth(1e-7, 1e-4)) << "phase " << phase;
    EXPECT_GT(deepest, -byWidth(1e-9, 1e-7)) << "phase " << phase;
    EXPECT_LT(gap(), byWidth(1e-9, 1e-7)) << "phase " << phase;
  }
}

TEST_P(ObstacleImpact, ReboundsWithTheRestitutionOfBoth) {
  fly(1e-3, 0.5);
  scene.run(1e-3 / GetParam().speed + 20 * kStep, kStep);
  EXPECT_NEAR(scene.state.v_W.x(), -0.5 * GetParam().speed, GetParam().speed * byWidth(1e-6, 1e-3));
}

INSTANTIATE_TEST_SUITE_P(Walls, ObstacleImpact,
                         ::testing::Values(Impact{true, 0.3}, Impact{true, 3.0}, Impact{false, 0.3},
                                           Impact{false, 3.0}));

TEST(ObstacleContact, LeavesABodyThatTouchesNothingAlone) {
  ObstacleScene scene;
  scene.addPlane(0.5);
  scene.start(Vec3(0, 0.03, 0));
  scene.weightless = true;
  scene.state.v_W = Vec3(0.1, -0.2, 0.3);
  const RigidState start = scene.state;
  scene.run(1e-3, 1.0 / 4000.0);
  EXPECT_EQ(scene.state.v_W, start.v_W);
  EXPECT_LT((scene.state.p_W - start.p_W - 1e-3 * start.v_W).norm(), 1e-15);
  EXPECT_EQ(scene.state.w_W, start.w_W);
}

TEST(ObstacleContact, KeepsACubeWhoseCentreIsOverTheEdge) {
  ObstacleScene scene;
  scene.addObstacle(
      scene.rig.makeShape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.05), btScalar(0.1))), 0.5,
      Vec3(-0.1, -0.05, 0));
  scene.start(Vec3(-0.003, 0.02, 0));
  const Vec3 start = scene.position();
  scene.run(1.0, 1.0 / 4000.0);
  EXPECT_LT((scene.position() - start).norm(), byWidth(1e-8, 2e-6));
  EXPECT_LT(scene.state.q_WB.angularDistance(Quat::Identity()), byWidth(1e-6, 1e-4));
}

TEST(ObstacleContact, LetsACubeTipWhoseCentreIsBeyondTheEdge) {
  ObstacleScene scene;
  scene.addObstacle(
      scene.rig.makeShape<btBoxShape>(btVector3(btScalar(0.1), btScalar(0.05), btScalar(0.1))), 2.0,
      Vec3(-0.1, -0.05, 0));
  scene.start(Vec3(0.005, 0.02, 0));
  double energy = scene.energy();
  const double start_energy = energy;
  // The cube tips about the edge without slip: sin(tilt) grows as for an inverted pendulum.
  scene.run(0.1, 1.0 / 4000.0, Vec3::Zero(), [&] { energy = std::max(energy, scene.energy()); });
  EXPECT_LT(scene.state.q_WB.angularDistance(test::turn(-0.5, {0, 0, 1})), 0.5);
  EXPECT_GT(scene.state.q_WB.angularDistance(Quat::Identity()), 0.2);
  EXPECT_LT(scene.state.w_W.z(), -2.0);
  // Semi-implicit steps add m g v dt / 2 of energy to a fall; v stays below 0.2 m/s.
  EXPECT_LT(energy - start_energy, ObstacleScene::kMass * ObstacleScene::kGravity * 0.2 / 8000.0);
  EXPECT_NEAR(scene.state.v_W.z(), 0.0, byWidth(1e-6, 1e-3));
}

TEST(ObstacleContact, DropsATiltedCubeWithoutGainOfEnergy) {
  ObstacleScene scene;
  scene.addBoxFloor(0.5);
  scene.start(Vec3(0, 0.05, 0), test::turn(0.5, {1, 0.4, 0.7}));
  double energy = scene.energy();
  double gain = 0;
  scene.run(1.5, 1.0 / 4000.0, Vec3::Zero(), [&] {
    gain = std::max(gain, scene.energy() - energy);
    energy = scene.energy();
  });
  // In one step a contact's arm is the one at its end: the error is second order in w dt.
  EXPECT_LT(gain, 1e-5);
  EXPECT_LT(scene.state.v_W.norm(), byWidth(1e-6, 1e-4));
  EXPECT_NEAR(scene.position().y(), ObstacleScene::kHalf, 5e-6);
}

TEST(ObstacleContact, HoldsACubeOnATriangleMesh) {
  constexpr int kCells = 8;
  constexpr double kCell = 0.03;  // [m]: the cube covers several triangles
  btTriangleMesh triangles;
  const auto corner = [](int i, int j) {
    return btVector3(static_cast<btScalar>((i - kCells / 2) * kCell), 0,
                     static_cast<btScalar>((j - kCells / 2) * kCell));
  };
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      triangles.addTriangle(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1));
      triangles.addTriangle(corner(i, j), corner(i + 1, j + 1), corner(i + 1, j));
    }
  }
  ObstacleScene scene;
  auto& mesh = scene.rig.makeShape<btBvhTriangleMeshShape>(&triangles, true);
  constexpr double kMargin = 1e-4;  // collision margin that Bullet adds around triangles [m]
  mesh.setMargin(static_cast<btScalar>(kMargin));
  scene.addObstacle(mesh, 0.5);
  scene.start(Vec3(0.004, ObstacleScene::kHalf + kMargin + 1e-3, 0.002),
              test::turn(0.4, {0, 1, 0}));
  scene.run(0.5, 1.0 / 4000.0);
  const Vec3 settled = scene.position();
  EXPECT_NEAR(settled.y(), ObstacleScene::kHalf + kMargin, 20e-6);
  scene.run(1.0, 1.0 / 4000.0);
  EXPECT_LT((scene.position() - settled).norm(), 50e-6);
  EXPECT_LT(scene.state.v_W.norm(), byWidth(1e-3, 5e-3));
}

// A small overlap left by the host stays. A deeper one is pushed out slowly, without speed.
TEST(ObstacleContact, LetsOverlapOutSlowlyAndWithoutSpeed) {
  for (const double overlap : {3e-4, 5e-3}) {
    ObstacleScene scene;
    scene.weightless = true;
    scene.addPlane(0.5);
    scene.start(Vec3(0, ObstacleScene::kHalf - overlap, 0));
    double fastest = 0;
    double previous = scene.position().y();
    scene.run(0.1, 1.0 / 4000.0, Vec3::Zero(), [&] {
      fastest = std::max(fastest, (scene.position().y() - previous) * 4000.0);
      previous = scene.position().y();
    });
    EXPECT_NEAR(scene.position().y(), ObstacleScene::kHalf - std::min(overlap, 5e-4),
                byWidth(1e-6, 2e-6));
    EXPECT_LT(fastest, 0.26);
    EXPECT_LT(scene.state.v_W.norm(), 1e-6);
  }
}

}  // namespace
}  // namespace tandem
