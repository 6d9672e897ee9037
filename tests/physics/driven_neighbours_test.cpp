// Kinematic bodies of the host: grippers, lifts, belts. The host moves them; they push and rub
// bodies that the island holds.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"

namespace tandem {
namespace {

using test::byWidth;
using test::kGravity;
using test::NeighbourScene;

constexpr double kHalf = NeighbourScene::kHalf;  // [m]
constexpr double kPeriod = 1.0 / 60;             // [s]

/// A scene ticked by hand, with a kinematic box that the host moves along a path.
struct DrivenScene : NeighbourScene {
  explicit DrivenScene(bool has_weight) : NeighbourScene(has_weight) {
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kPeriod;
  }
  btRigidBody& addDriven(const Vec3& half, const Vec3& p_W) {
    driven = &rig.addBody(rig.makeShape<btBoxShape>(toBullet(half)), 0.0, p_W);
    rig.world.removeRigidBody(driven);
    driven->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    driven->setActivationState(DISABLE_DEACTIVATION);
    driven->setFriction(static_cast<btScalar>(std::sqrt(kFriction)));
    rig.world.addRigidBody(driven);
    return *driven;
  }
  [[nodiscard]] double now() const { return static_cast<double>(site->tickCount()) / 1000.0; }
  [[nodiscard]] double hostTime() const { return steps * kPeriod; }

  /// The host, `late` [s], moves the driven body to `place`(t) for the step that ends at t.
  template <typename Place, typename EachTick>
  void runDriven(double until, double late, Place place, EachTick each_tick) {
    while (hostTime() < until - 1e-9) {
      while (now() < hostTime() + kPeriod + late - 1e-9) {
        site->tick(now());
        each_tick();
      }
      driven->setWorldTransform(place(hostTime() + kPeriod));
      rig.step(kPeriod);
      ++steps;
    }
  }
  btRigidBody* driven = nullptr;
  int steps = 0;
};

class DrivenNeighbours : public ::testing::TestWithParam<double> {};

// A moving floor carries the cube: Coulomb friction holds it up to mu g.
TEST_P(DrivenNeighbours, MovingFloorCarriesTheCube) {
  DrivenScene scene(true);
  scene.addDriven(Vec3(0.5, 0.5, 0.05), Vec3(0.0, 0.0, -0.05));
  scene.start(Vec3(0.0, 0.0, kHalf));
  // The floor goes from rest to 0.3 m/s with 1 m/s^2, below mu g = 2.9.
  const auto x = [](double t) { return t < 0.3 ? 0.5 * t * t : 0.3 * t - 0.045; };
  scene.runDriven(
      1.5, GetParam(), [&](double t) { return toBullet(Vec3(x(t), 0.0, -0.05), Quat::Identity()); },
      [] {});
  EXPECT_NEAR(scene.site->object(0).v_W.x(), 0.3, 1e-6);
  EXPECT_NEAR(scene.site->object(0).p_W.z(), kHalf, 1e-5);
  // The cube slides by the lateness: at most v^2 / 2 mu g less than the way of two periods and the
  // delay.
  EXPECT_NEAR(scene.positionOf(*scene.cube).x(), x(scene.hostTime()),
              0.3 * (2 * kPeriod + GetParam()));
  EXPECT_EQ(scene.site->neighbourCount(), 1);
}

// The floor starts too fast: the cube slips with mu g until it is as fast.
TEST_P(DrivenNeighbours, MovingFloorSlipsUnderTheCube) {
  DrivenScene scene(true);
  scene.addDriven(Vec3(2.0, 0.5, 0.05), Vec3(-0.1, 0.0, -0.05));
  scene.start(Vec3(0.0, 0.0, kHalf));
  std::vector<Vec3> velocities;
  scene.runDriven(
      1.5, GetParam(),
      [&](double t) { return toBullet(Vec3(t - 0.1, 0.0, -0.05), Quat::Identity()); },
      [&] { velocities.push_back(scene.site->object(0).v_W); });
  // 1 m/s at 2.943 m/s^2 takes 0.34 s. Slipping has begun by 0.1 s. The island's floor catches up
  // with the host's by e^-10 t: to 5e-8 m/s.
  const double gained = velocities[300].x() - velocities[200].x();
  EXPECT_NEAR(gained, 0.1 * NeighbourScene::kFriction * kGravity, 2e-3);
  EXPECT_NEAR(velocities.back().x(), 1.0, test::byWidth(1e-6, 1e-5));
}

// A wall pushes the cube, face on face, without overlap, at the wall's speed.
TEST_P(DrivenNeighbours, MovingWallPushesTheCube) {
  for (const bool on_floor : {false, true}) {
    DrivenScene scene(on_floor);
    if (on_floor) scene.addFloor();
    const double z = on_floor ? kHalf : 0.0;
    scene.addDriven(Vec3(0.02, 0.1, 0.1), Vec3(-0.08, 0.0, z + 0.11 - kHalf));
    scene.start(Vec3(0.0, 0.0, z));
    scene.runDriven(
        1.0, GetParam(),
        [&](double t) {
          return toBullet(Vec3(-0.08 + 0.2 * t, 0.0, z + 0.11 - kHalf), Quat::Identity());
        },
        [] {});
    EXPECT_NEAR(scene.site->object(0).v_W.x(), 0.2, 1e-6) << on_floor;
    EXPECT_NEAR(scene.positionOf(*scene.cube).x() - scene.positionOf(*scene.driven).x(), 0.04, 1e-5)
        << on_floor;
    EXPECT_LT(std::abs(scene.site->object(0).w_W.norm()), 1e-3);
  }
}

// The wall swings and is never steady. Errors of prediction are corrected without a kick.
TEST_P(DrivenNeighbours, SwingingWallKeepsTheCubeOnItsFace) {
  DrivenScene scene(true);
  scene.addFloor();
  scene.addDriven(Vec3(0.02, 0.1, 0.1), Vec3(-0.0405, 0.0, 0.101));
  scene.start(Vec3(0.0, 0.0, kHalf));
  // 3 cm at 0.5 Hz is at most 0.1 m/s.
  double fastest = 0.0;
  const auto x = [](double t) { return -0.0405 + 0.03 * std::sin(M_PI * t); };
  scene.runDriven(
      2.0, GetParam(), [&](double t) { return toBullet(Vec3(x(t), 0.0, 0.101), Quat::Identity()); },
      [&] { fastest = std::max(fastest, scene.site->object(0).v_W.norm()); });
  // The wall starts at full speed. The cube is then two periods and the delay behind, and catches
  // up in 0.1 s.
  EXPECT_LT(fastest, 0.03 * M_PI * (1.0 + (2 * kPeriod + GetParam()) / 0.1));
  // The cube stays where the wall turned back: friction stops it at once.
  EXPECT_NEAR(scene.positionOf(*scene.cube).x(), 0.03 - 5e-4, 1.5e-3);
}

// Rotation counts: a turning paddle hits the cube with w x r.
TEST_P(DrivenNeighbours, TurningPaddleSweepsTheCube) {
  DrivenScene scene(false);
  scene.addDriven(Vec3(0.2, 0.005, 0.05), Vec3(0.0, -0.1, 0.0));
  scene.start(Vec3(0.15, 0.0, 0.0));
  const auto pose = [](double t) {
    return toBullet(Vec3(0.0, -0.1, 0.0), test::turn(1.0 * t, Vec3::UnitZ()));
  };
  scene.runDriven(1.0, GetParam(), pose, [] {});
  const Vec3 v = scene.site->object(0).v_W;
  // The speed is about 0.15 m/s, across the paddle at the time of contact.
  EXPECT_NEAR(v.norm(), 0.17, 0.06);
  EXPECT_GT(v.y(), 0.1);
}
// The host's step in single precision ends 47 ps after the tick, and ticks drift across it.
TEST(DrivenWall, RoundingOfTheHostsStepIsNoBlow) {
  DrivenScene scene(true);
  scene.settings.tick_source = TickSource::kHostStep;
  const double step = static_cast<double>(0.001F);
  scene.settings.host_step = step;
  scene.addFloor();
  btRigidBody& wall = scene.addDriven(Vec3(0.02, 0.1, 0.1), Vec3(-0.06, 0.0, 0.11));
  scene.start(Vec3(0.0, 0.0, kHalf));
  for (int i = 1; i <= 1000; ++i) {
    const double x = -0.06 + 0.05 * (1.0 - std::cos(5.0 * i * step));
    wall.setWorldTransform(toBullet(Vec3(x, 0.0, 0.11), Quat::Identity()));
    scene.rig.step(step);
    // The wall reaches 0.25 m/s.
    ASSERT_LT(static_cast<double>(scene.cube->getLinearVelocity().length()), 0.4) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Lateness, DrivenNeighbours, ::testing::Values(0.0, kPeriod, 0.025));

// From the first sub-step on Bullet has the pose of the end of all sub-steps.
TEST(DrivenNeighbour, SubStepsDoNotMakeItFaster) {
  NeighbourScene scene;
  scene.settings.host_step = kPeriod;
  btRigidBody& wall =
      scene.rig.addBody(scene.rig.makeShape<btBoxShape>(toBullet(Vec3(0.02, 0.1, 0.1))), 0.0,
                        Vec3(-0.0405, 0.0, 0.0));
  scene.rig.world.removeRigidBody(&wall);
  wall.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  wall.setActivationState(DISABLE_DEACTIVATION);
  scene.rig.world.addRigidBody(&wall);
  scene.start();
  for (int call = 1; call <= 10; ++call) {
    const double t = call * 4 * kPeriod;
    wall.setWorldTransform(toBullet(Vec3(-0.0405 + 0.2 * t, 0.0, 0.0), Quat::Identity()));
    scene.rig.world.stepSimulation(static_cast<btScalar>(4 * kPeriod), 4,
                                   static_cast<btScalar>(kPeriod));
    EXPECT_LT(scene.site->object(0).v_W.x(), 0.2 + 1e-6) << call;
    EXPECT_NEAR(scene.positionOf(*scene.cube).x() - scene.positionOf(wall).x(), 0.04,
                call < 2 ? 0.2 * 4 * kPeriod : 1e-4)
        << call;
  }
}

// The belt stays in place but has a velocity: only its surface moves.
TEST(DrivenNeighbour, BeltCarriesTheCubeAndStays) {
  DrivenScene scene(true);
  btRigidBody& belt = scene.addDriven(Vec3(1.0, 0.2, 0.05), Vec3(0.0, 0.0, -0.05));
  scene.start(Vec3(0.0, 0.0, kHalf));
  // Bullet computes kinematic velocities before each step. The host's callback replaces them.
  struct Belt {
    static void run(btDynamicsWorld* world, btScalar) {
      static_cast<btRigidBody*>(world->getWorldUserInfo())
          ->setLinearVelocity(btVector3(btScalar(0.2), 0, 0));
    }
  };
  scene.site.reset();
  scene.rig.world.setInternalTickCallback(Belt::run, &belt, true);
  scene.site = std::make_unique<Site>(scene.settings, scene.rig.world, scene.device);
  scene.site->share(*scene.cube);
  scene.runDriven(
      1.0, 0.0, [&](double) { return toBullet(Vec3(0.0, 0.0, -0.05), Quat::Identity()); }, [] {});
  EXPECT_NEAR(scene.site->object(0).v_W.x(), 0.2, 1e-6);
  EXPECT_NEAR(scene.positionOf(*scene.cube).x(), 0.2, 0.03);
  EXPECT_NEAR(scene.site->object(0).p_W.z(), kHalf, 1e-5);
  // The belt stops, and the load stops too.
  scene.rig.world.setWorldUserInfo(&scene.rig.addCube(0.0, 0.01, Vec3(0.0, 0.0, 5.0)));
  scene.runDriven(
      1.5, 0.0, [&](double) { return toBullet(Vec3(0.0, 0.0, -0.05), Quat::Identity()); }, [] {});
  EXPECT_LT(scene.site->object(0).v_W.norm(), 1e-6);
  scene.site.reset();
}

// A kinematic body pushes the hand; the hand's reaction does not move the body.
TEST(DrivenNeighbour, IsFeltByTheHand) {
  DrivenScene scene(false);
  scene.addDriven(Vec3(0.02, 0.1, 0.1), Vec3(-0.1, 0.0, 0.0));
  scene.start(Vec3(0.0, 0.5, 0.0));
  scene.device.sample.hip.p_W = Vec3(0.0, 0.0, 0.0);
  // Its face rises from below to 1 cm + 2 mm of overlap, and stops there.
  const auto x = [](double t) { return -0.03 + 0.002 - 0.072 * std::max(0.0, 1.0 - 2.0 * t); };
  scene.runDriven(
      2.5, kPeriod, [&](double t) { return toBullet(Vec3(x(t), 0.0, 0.0), Quat::Identity()); },
      [] {});
  EXPECT_NEAR(scene.site->force().x(), 2000.0 * 0.002, 1e-4);
}

/// A scene with a kinematic box at x = -1 m, far from the cube.
struct LeapingWall : DrivenScene {
  explicit LeapingWall(TickSource source) : DrivenScene(false) {
    settings.tick_source = source;
    addDriven(Vec3(0.02, 0.02, 0.02), Vec3(-1.0, 0.0, 0.0));
    start();
  }
  /// Steps of `period` [s]. The host puts the box to `places` in turn, and leaves it at the last.
  void follow(const std::vector<double>& places, double period) {
    for (int step = 0; step < 20; ++step) {
      const std::size_t place = std::min<std::size_t>(step, places.size() - 1);
      driven->setWorldTransform(toBullet(Vec3(places[place], 0.0, 0.0), Quat::Identity()));
      const double end = (steps + 1) * period - 1e-9;
      while (settings.tick_source == TickSource::kCaller && now() < end) site->tick(now());
      rig.step(period);
      ++steps;
    }
  }
};

// Bullet gives what is put elsewhere the speed of a body that went there. The island let it go on
// at 39 m/s, through the cube.
TEST(DrivenNeighbour, ThatIsPutElsewhereStrikesNothing) {
  for (const TickSource source : {TickSource::kHostStep, TickSource::kCaller})
    for (const double period : {kPeriod, 0.0025}) {
      LeapingWall scene(source);
      scene.settings.host_step = period;
      scene.follow({-0.35, -0.35, -0.1}, period);
      EXPECT_LT(NeighbourScene::velocityOf(*scene.cube).norm(), 1e-9) << period;
    }
}

// One that goes on as fast is believed: it strikes.
TEST(DrivenNeighbour, ThatIsFastStrikes) {
  LeapingWall scene(TickSource::kHostStep);
  scene.follow({-0.8, -0.7, -0.6, -0.5, -0.4, -0.3, -0.2, -0.1, 0.0, 0.1, 0.2}, kPeriod);
  EXPECT_GT(NeighbourScene::velocityOf(*scene.cube).x(), 0.1 / kPeriod - 1e-6);
}

// The lift goes up and down, more slowly than the cube would fall.
TEST(DrivenNeighbour, LiftCarriesTheCube) {
  for (const double late : {0.0, kPeriod}) {
    DrivenScene scene(true);
    scene.addDriven(Vec3(0.1, 0.1, 0.02), Vec3(0.0, 0.0, -0.02));
    scene.start(Vec3(0.0, 0.0, kHalf));
    const auto z = [](double t) { return -0.02 + 0.05 * (1.0 - std::cos(M_PI * t)); };
    scene.runDriven(
        2.5, late, [&](double t) { return toBullet(Vec3(0.0, 0.0, z(t)), Quat::Identity()); },
        [] {});
    EXPECT_NEAR(scene.positionOf(*scene.cube).z(), z(scene.hostTime()) + 0.04, 3e-3) << late;
    EXPECT_NEAR(scene.site->object(0).p_W.head<2>().norm(), 0.0, 1e-5) << late;
  }
}

}  // namespace
}  // namespace tandem
