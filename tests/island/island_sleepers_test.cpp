#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]
constexpr double kHalf = 0.02, kRadius = 0.01;
constexpr int kCubes = 49;

/// A device among cubes that float at rest in a grid, 10 cm apart, each tied to its place.
struct Grid {
  Grid() {
    IslandBody device;
    device.motion = Motion::kPrescribed;
    device.shape = Sphere{kRadius};
    device.start.p_W = Vec3(-0.2, 0.0, 0.0);
    hip = island.addBody(device);
    IslandBody cube;
    cube.shape = Box{Vec3::Constant(kHalf)};
    cube.mass = 0.2;
    cube.inertia_B = Vec3::Constant(cube.mass * 4.0 * kHalf * kHalf / 6.0);
    for (int i = 0; i < kCubes; ++i) {
      cube.start.p_W = Vec3(0.1 * (i % 7), 0.1 * (i / 7), 0.0);
      cubes.push_back(island.addBody(cube));
      island.addContact(hip, cubes.back(), {2000.0, 10.0});
      couplers.push_back(island.addCoupler(cubes.back(), {{500.0, 5.0}, {0.1, 1e-3}}));
    }
    island.prepare();
  }

  /// Runs a tick in which the device moves at `v_W`; `awake` keeps all bodies awake.
  void tick(const Vec3& v_W, bool awake = false) {
    RigidState state = island.state(hip);
    state.v_W = v_W;
    island.setState(hip, state);
    if (awake) island.wake();
    island.advance(kPeriod);
  }
  void moveFor(int ticks, const Vec3& v_W) {
    for (int i = 0; i < ticks; ++i) tick(v_W);
  }
  [[nodiscard]] bool isAwake(BodyIndex body) const {
    const auto& awake = island.awakeBodies();
    return std::find(awake.begin(), awake.end(), body) != awake.end();
  }

  Island island{IslandSettings{}};
  BodyIndex hip = 0;
  std::vector<BodyIndex> cubes;
  std::vector<CouplerIndex> couplers;
};

TEST(Sleepers, CostNothingWhileTheDeviceMovesElsewhere) {
  Grid grid;
  grid.moveFor(10, Vec3(0.0, -0.3, 0.0));
  const IslandCounters before = grid.island.counters();
  grid.moveFor(100, Vec3(0.0, -0.3, 0.0));
  const IslandCounters& after = grid.island.counters();
  EXPECT_EQ(after.asleep, before.asleep) << "the device moves";
  EXPECT_EQ(after.asleep_bodies - before.asleep_bodies, 100u * kCubes);
  EXPECT_EQ(after.exact_bodies, before.exact_bodies);
  EXPECT_EQ(after.contact_searches, before.contact_searches);
  EXPECT_EQ(after.contact_searches_skipped, before.contact_searches_skipped);
  EXPECT_EQ(grid.island.awakeBodies(), std::vector<BodyIndex>{grid.hip});
}

TEST(Sleepers, AreFeltAsIfTheyHadBeenAwake) {
  // The device passes through the middle of a row, at speeds from a crawl to a throw.
  for (const double speed : {0.02, 0.2, 2.0, 10.0}) {
    Grid sleeping, waking;
    double most_force = 0.0, worst = 0.0;
    std::size_t most_awake = 0;
    const int ticks = std::min(2000, static_cast<int>(0.6 / (speed * kPeriod)));
    for (int tick = 0; tick < ticks; ++tick) {
      const Vec3 v_W(speed, 0.1 * speed, 0.0);
      sleeping.tick(v_W);
      waking.tick(v_W, true);
      most_awake = std::max(most_awake, sleeping.island.awakeBodies().size());
      const Vec3 f_W = waking.island.computeContactForce(waking.hip);
      most_force = std::max(most_force, f_W.norm());
      EXPECT_NEAR((sleeping.island.computeContactForce(sleeping.hip) - f_W).norm(), 0.0, 1e-6)
          << "tick " << tick << " at " << speed << " m/s";
      for (const BodyIndex cube : sleeping.cubes)
        worst = std::max(worst,
                         (sleeping.island.state(cube).p_W - waking.island.state(cube).p_W).norm());
    }
    if (speed > 0.1) {
      EXPECT_GT(most_force, 1.0) << "nothing was touched";
    }
    EXPECT_LT(worst, 1e-9) << speed;
    EXPECT_LT(most_awake, 20u) << speed;
  }
}

TEST(Sleepers, WakeByWhatIsDoneToThem) {
  Grid grid;
  const auto sleeps = [&](int i) { return !grid.isAwake(grid.cubes[static_cast<std::size_t>(i)]); };
  const Vec3 away(0.0, -0.1, 0.0);
  grid.moveFor(10, away);
  for (int i = 0; i < kCubes; ++i) ASSERT_TRUE(sleeps(i)) << i;

  grid.island.applyImpulse(grid.cubes[3], Vec3(0.0, 0.01, 0.0), Vec3::Zero());
  RigidState target = grid.island.target(grid.couplers[11]);
  target.p_W.z() += 1e-3;
  grid.island.setTarget(grid.couplers[11], target);
  grid.island.setExternalWrench(grid.cubes[20], Vec3(0.0, 0.0, 0.1), Vec3::Zero());
  RigidState state = grid.island.state(grid.cubes[30]);
  state.p_W.z() -= 2e-3;
  grid.island.setState(grid.cubes[30], state);
  grid.moveFor(1, away);
  for (int i = 0; i < kCubes; ++i)
    EXPECT_EQ(sleeps(i), i != 3 && i != 11 && i != 20 && i != 30) << i;

  grid.moveFor(3000, Vec3(0.0, -1e-3, 0.0));
  for (int i = 0; i < kCubes; ++i) EXPECT_TRUE(sleeps(i)) << i << " is at rest again";
  EXPECT_NEAR(grid.island.state(grid.cubes[11]).p_W.z(), 1e-3, 1e-9);
  EXPECT_NEAR(grid.island.state(grid.cubes[20]).p_W.z(), 0.1 / 500.0, 1e-9);
  EXPECT_NEAR(grid.island.state(grid.cubes[30]).p_W.z(), 0.0, 1e-9);
}

// The device takes random paths through the grid. A sleeping body must be hit as if it were awake.
TEST(Sleepers, AreMetOnAnyWay) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> turn(-1.0, 1.0);
    Grid sleeping, waking;
    Vec3 v_W(0.5, 0.2, 0.0);
    for (int tick = 0; tick < 1000; ++tick) {
      if (tick % 20 == 0) v_W += 0.3 * Vec3(turn(random), turn(random), 0.2 * turn(random));
      if (tick % 200 == 199) v_W.setZero();
      sleeping.tick(v_W);
      waking.tick(v_W, true);
    }
    double worst = 0.0;
    for (const BodyIndex cube : sleeping.cubes)
      worst =
          std::max(worst, (sleeping.island.state(cube).p_W - waking.island.state(cube).p_W).norm());
    EXPECT_LT(worst, 1e-8);
  }
}

}  // namespace
}  // namespace tandem
