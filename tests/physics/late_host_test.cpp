// A host whose steps come late, unevenly, or not at all for a while. The hand feels the same as
// with a punctual host.

#include "physics/late_host.h"

#include <gtest/gtest.h>

#include "physics/neighbour_scene.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BenchBody;
using test::BenchScene;
using test::BenchTool;
using test::byWidth;
using test::HostTiming;
using test::LateHost;
using test::NeighbourScene;
using test::ReferenceRun;
using test::RunErrors;

constexpr int kReferenceRate = 48000;  // [Hz]
constexpr double kPeriod = 1.0 / 60;   // [s]

const HostTiming kPunctual{};
const HostTiming kOnePeriodLate{.late = kPeriod};
const HostTiming kJittering{.jitter = 0.010, .seed = 1};
const HostTiming kLateAndJittering{.late = kPeriod, .jitter = 0.010, .seed = 2};
const HostTiming kFast{.rate = 240, .late = 1.0 / 240};

HostTiming makeStall(double at, int rate = 60) {
  return {.rate = rate, .stall_at = at, .stall = 0.2};
}

BenchBody makeBox(const char* name, double mass, const Vec3& p_W, const Vec3& v_W = Vec3::Zero()) {
  BenchBody box;
  box.name = name;
  box.shape = demos::bench::BoxShape{};
  box.mass = mass;
  box.start.p_W = p_W;
  box.start.v_W = v_W;
  return box;
}

/// A box that only Bullet knows flies at `speed` into a cube that a tool holds, from distance
/// `way`.
BenchScene makeFlight(double speed, double way) {
  BenchScene scene;
  scene.name = "flight";
  scene.duration = way / speed + 0.25;
  scene.friction = 0.3;
  BenchTool tool;
  tool.start.p_W = Vec3(-0.03, 0.0, 0.0);
  tool.device = [](double) { return PointState{Vec3(-0.03, 0.0, 0.0), Vec3::Zero()}; };
  scene.tools = {tool};
  scene.bodies = {makeBox("cube", 0.1, Vec3::Zero()),
                  makeBox("box", 0.2, Vec3(0.04 + way, 0.0, 0.0), Vec3(-speed, 0.0, 0.0))};
  scene.bodies[0].is_shared = true;
  return scene;
}

const BenchScene& findScene(const std::string& name) {
  for (const BenchScene& scene : demos::bench::allScenes())
    if (scene.name == name) return scene;
  throw std::invalid_argument("no scene " + name);
}

/// A scene of the bench and its allowed errors: tool [m], coupler force [N] and body [m].
struct LateCase {
  const char* scene;
  RunErrors most;
};

class LateHostOnScenes : public ::testing::TestWithParam<LateCase> {};

// Boxes of a float host settle at arbitrary places: a stack of them creeps by half a millimetre.
TEST_P(LateHostOnScenes, IsAsGoodAsAPunctualOne) {
  const BenchScene& scene = findScene(GetParam().scene);
  const ReferenceRun reference = runPlanarReference(scene, kReferenceRate);
  for (const HostTiming& timing : {kPunctual, kOnePeriodLate, kJittering, kLateAndJittering, kFast,
                                   makeStall(0.3), makeStall(0.3, 240)}) {
    LateHost host(scene, timing);
    const RunErrors errors = compareLate(host, scene, reference);
    EXPECT_LT(errors.tool, GetParam().most.tool);
    EXPECT_LT(errors.force, GetParam().most.force);
    EXPECT_LT(errors.body, GetParam().most.body);
    EXPECT_EQ(host.site().status(), kTickOk);
    EXPECT_EQ(host.site().counters().host_clock_set, 0u);
  }
}
// At least twice the measured error, which depends on where in an inner step an impact falls.
INSTANTIATE_TEST_SUITE_P(Scenes, LateHostOnScenes,
                         ::testing::Values(LateCase{"free_box", {2e-5, 2e-5, 0.01}},
                                           LateCase{"free_box_fast", {2e-5, 4e-5, 0.03}},
                                           LateCase{"row", {2e-5, 3e-5, 0.03}},
                                           LateCase{"squeeze", {4e-5, 2e-5, 0.07}},
                                           LateCase{"stack", {1e-4, byWidth(2e-4, 2e-3), 0.2}},
                                           LateCase{"wall", {2e-5, 1e-5, 0.02}}));

// Scenes vii and viii: the island knows the box only when it is near.
TEST(LateHost, FlyingBoxIsMetWhereItIs) {
  for (const auto& [speed, way, stall_at] :
       {std::tuple(0.5, 0.2513, 0.35), std::tuple(2.0, 0.5013, 0.1)}) {
    const BenchScene scene = makeFlight(speed, way);
    const ReferenceRun reference = runPlanarReference(scene, kReferenceRate);
    for (const HostTiming& timing : {kPunctual, kOnePeriodLate, kJittering, kLateAndJittering,
                                     makeStall(stall_at), makeStall(stall_at, 240)}) {
      LateHost host(scene, timing);
      const RunErrors errors = compareLate(host, scene, reference);
      EXPECT_LT(errors.tool, speed < 1.0 ? 5e-5 : 1e-4) << speed;
      EXPECT_LT(errors.force, speed < 1.0 ? 0.2 : 0.5) << speed;
      EXPECT_GE(host.site().counters().promoted, 1u);
    }
  }
}

// The motion is the same to the last digits at any lateness: no tick is rounded to the host's time.
TEST(LateHost, MotionOfToolsDoesNotDependOnIt) {
  const BenchScene& scene = findScene("row");
  const auto run = [&](const HostTiming& timing) {
    LateHost host(scene, timing);
    std::vector<Vec3> way;
    host.run(
        scene.duration, [&] { way.push_back(host.site().proxy(0)->p_W); }, [] {});
    return way;
  };
  const std::vector<Vec3> punctual = run(kPunctual);
  for (const HostTiming& timing : {kOnePeriodLate, kJittering, makeStall(0.3)}) {
    const std::vector<Vec3> late = run(timing);
    double worst = 0.0;
    for (std::size_t i = 0; i < late.size(); ++i)
      worst = std::max(worst, (late[i] - punctual[i]).norm());
    EXPECT_LT(worst, byWidth(1e-6, 1e-5));
  }
}

/// A site ticked by hand, and a host that is called some of its periods late.
struct LateScene : NeighbourScene {
  explicit LateScene(bool has_weight = false) : NeighbourScene(has_weight) {
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kPeriod;
  }
  void tickUntil(double time) {
    while (now() < time - 1e-9) site->tick(now());
  }
  [[nodiscard]] double now() const { return static_cast<double>(site->tickCount()) / 1000.0; }
  /// Runs host steps until the host's `time`, each `periods` late.
  template <typename EachStep>
  void runHostUntil(double time, int periods, EachStep before_step) {
    while (static_cast<double>(steps) * kPeriod < time - 1e-9) {
      tickUntil((steps + 1 + periods) * kPeriod);
      before_step();
      rig.step(kPeriod);
      ++steps;
    }
  }
  int steps = 0;
};

// A steady force of the host stays steady at any lateness, and its momentum arrives in full.
TEST(LateHost, ItsForceIsSteadyAndWhole) {
  for (const int periods : {0, 1, 2}) {
    LateScene scene;
    scene.start();
    Vec3 v_before = Vec3::Zero();
    double least = 1e9, most = 0.0;
    scene.runHostUntil(1.0, periods, [&] {
      scene.cube->applyCentralForce(btVector3(2, 0, 0));
      const Vec3 v = scene.site->object(0).v_W;
      if (scene.steps > 10 && scene.steps % 3 == 0) {
        least = std::min(least, (v - v_before).x());
        most = std::max(most, (v - v_before).x());
      }
      if (scene.steps % 3 == 0) v_before = v;
    });
    // Three periods are 50 ticks: 2 N on 0.1 kg for 50 ms.
    EXPECT_NEAR(least, 1.0, 0.02) << periods;
    EXPECT_NEAR(most, 1.0, 0.02) << periods;
    scene.runHostUntil(1.5, periods, [] {});
    EXPECT_NEAR(scene.site->object(0).v_W.x(), 60 * 2.0 * kPeriod / 0.1, byWidth(1e-9, 1e-4))
        << periods;
  }
}

TEST(LateHost, ItsTeleportHoldsFromThenOn) {
  LateScene scene;
  scene.start();
  scene.runHostUntil(0.1, 2, [] {});
  scene.cube->setWorldTransform(toBullet(Vec3(0.0, 0.5, 0.0), Quat::Identity()));
  for (int i = 0; i < 5; ++i) {
    scene.runHostUntil(0.1 + (i + 1) * kPeriod, 2, [] {});
    EXPECT_NEAR(scene.positionOf(*scene.cube).y(), 0.5, byWidth(1e-12, 1e-7)) << i;
  }
}

// The island is two periods ahead when it learns of the box, which lies on the cube. Without
// support the box would fall g t^2 / 2 = 5 mm until then. Bullet lets it sink by 2 mm in its first
// step; it may keep 0.5 mm.
TEST(LateHost, NewcomerOnAHeldCubeDoesNotFallThrough) {
  double z[2];
  for (const int periods : {0, 2}) {
    LateScene scene(true);
    scene.addFloor();
    scene.start(Vec3(0.0, 0.0, 0.02));
    scene.runHostUntil(0.2, periods, [] {});
    btRigidBody& box = scene.addBox(Vec3(0.0, 0.0, 0.06));
    scene.runHostUntil(0.2 + 2 * kPeriod, periods, [] {});
    EXPECT_GT(scene.positionOf(box).z(), 0.0593);
    scene.runHostUntil(0.4, periods, [] {});
    EXPECT_EQ(scene.site->neighbourCount(), 1);
    EXPECT_NEAR(scene.site->object(0).p_W.z(), 0.02, 1e-6);
    z[periods / 2] = scene.positionOf(box).z();
  }
  EXPECT_NEAR(z[0], z[1], 1e-5);
}

// A whole stack enters late.
TEST(LateHost, NewStackStands) {
  LateScene scene(true);
  scene.addFloor();
  scene.start(Vec3(0.0, 0.0, 0.02));
  scene.runHostUntil(0.2, 2, [] {});
  for (int i = 0; i < 4; ++i) scene.addBox(Vec3(0.045, 0.0, 0.02 + 0.04 * i));
  scene.runHostUntil(0.5, 2, [] {});
  ASSERT_EQ(scene.site->neighbourCount(), 4);
  for (int i = 0; i < 4; ++i) {
    const Vec3 p_W = scene.positionOf(*scene.boxes[static_cast<std::size_t>(i)]);
    EXPECT_NEAR(p_W.z(), 0.02 + 0.04 * i, 2e-3);
    EXPECT_LT(p_W.head<2>().norm() - 0.045, 1e-3);
  }
}

// The island keeps its past states for the moments that a late host announced. A float's 1/60 s
// drifts from these, and a host may step at any time.
TEST(LateHost, StepsThatNobodyAnnouncedAreMetAllTheSame) {
  for (const bool is_uneven : {false, true}) {
    SCOPED_TRACE(is_uneven ? "uneven" : "rounded");
    test::BulletRig host(Vec3::Zero());
    test::FakeDevice device{Vec3(0.0, 0.0, 1.0)};
    btRigidBody& cube = host.addCube(0.2, 0.02, Vec3::Zero());
    SiteSettings settings;
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kPeriod;
    settings.coordination = {0.0, 0.0};
    Site site(settings, host.world, device);
    site.share(cube);
    cube.setLinearVelocity(btVector3(1, 0, 0));
    double host_time = 0.0, x_last = 0.0;
    int ticks = 0;
    for (int step = 0; step < 60; ++step) {
      const double dt = is_uneven ? kPeriod * (0.6 + 0.1 * (7 * step % 5))
                                  : static_cast<double>(float{1.0f / 60});
      while (1e-3 * ticks < host_time + 2.0 * kPeriod) site.tick(1e-3 * ticks++);
      host.step(dt);
      host_time += dt;
      const auto x = static_cast<double>(cube.getWorldTransform().getOrigin().x());
      if (step > 5) {
        EXPECT_NEAR(x - x_last, dt, byWidth(1e-9, 1e-6)) << "step " << step;
      }
      x_last = x;
    }
  }
}

// The island sees the box late: the cube has already passed through its place. Momentum is
// conserved, and no energy is created.
TEST(LateHost, BoxThatAppearsInTheWayIsHitAfterTheFact) {
  for (const double mass : {0.02, 0.2, 20.0}) {
    LateScene scene;
    scene.start();
    scene.runHostUntil(0.1, 2, [] {});
    scene.cube->setLinearVelocity(btVector3(1, 0, 0));
    scene.runHostUntil(0.2, 2, [] {});
    const double gap = 5e-3;
    scene.addBox(Vec3(scene.positionOf(*scene.cube).x() + 0.04 + gap, 0.0, 0.0), mass);
    scene.runHostUntil(0.6, 2, [] {});
    EXPECT_NEAR(scene.momentum().x(), 0.1, byWidth(1e-9, 1e-5)) << mass;
    EXPECT_LT(scene.energy(), 0.5 * 0.1 * 1.0) << mass;
    EXPECT_GE(scene.velocityOf(*scene.boxes[0]).x(),
              scene.velocityOf(*scene.cube).x() - byWidth(1e-6, 1e-5));
  }
}

// An impulse that the island gave the box while the host was late returns with the box.
TEST(LateHost, BoxTakesAlongWhatIsOwed) {
  LateScene scene;
  btRigidBody& box = scene.addBox(Vec3(0.045, 0.0, 0.0));
  scene.start();
  scene.runHostUntil(0.1, 2, [] {});
  ASSERT_EQ(scene.site->neighbourCount(), 1);
  box.applyCentralImpulse(btVector3(0, 2, 0));
  scene.runHostUntil(0.1 + kPeriod, 2, [] {});
  scene.site.reset();
  EXPECT_NEAR(scene.velocityOf(box).y(), 10.0, byWidth(1e-9, 1e-5));
}

// After a debugger's break the host drops the lost time and continues from where it was.
TEST(LateHost, LostTimeIsForgotten) {
  LateScene scene(true);
  scene.addFloor();
  scene.addBox(Vec3(0.045, 0.0, 0.02));
  scene.start(Vec3(0.0, 0.0, 0.02));
  scene.runHostUntil(0.2, 0, [] {});
  scene.tickUntil(scene.now() + 10.0);
  for (int i = 0; i < 60; ++i) {
    scene.tickUntil(10.2 + i * kPeriod);
    scene.rig.step(kPeriod);
  }
  EXPECT_EQ(scene.site->counters().host_clock_set, 1u);
  EXPECT_NEAR(scene.positionOf(*scene.cube).z(), 0.02, 1e-5);
  scene.cube->setLinearVelocity(btVector3(btScalar(0.3), 0, 0));
  scene.tickUntil(scene.now() + 0.1);
  scene.rig.step(kPeriod);
  scene.tickUntil(scene.now() + 0.001);
  EXPECT_GT(scene.site->object(0).v_W.x(), 0.2);
}

}  // namespace
}  // namespace tandem
