// Stacks of cubes that stand for long, solved in each tick: nothing rests or sleeps.

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "island/box_scene.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr double kHalf = 0.02;    // [m]
constexpr double kMass = 0.2;     // [kg]
constexpr double kDrift = 1e-12;  // rounding of 18 cubes' loads, over contact stiffness [m]
constexpr std::uint64_t kSeed = 20261125;

double computeDrift(const test::BoxScene& scene) {
  double most = 0.0;
  for (BodyIndex b = 0; b < scene.island.bodyCount(); ++b) {
    const Vec3 start_W(0, 0, (2 * b + 1) * kHalf);
    const RigidState& state = scene.island.state(b);
    most = std::max({most, (state.p_W - start_W).norm(), 2.0 * kHalf * state.q_WB.vec().norm()});
  }
  return most;
}

struct Stack {
  test::BoxScene scene;
  explicit Stack(const std::vector<double>& masses) { test::stack(scene, kHalf, masses); }

  /// Gives each corner an error of its distance of up to `most` [m].
  void setCornerGaps(test::Random& random, double most) {
    for (auto& pair : scene.world.pairs)
      for (double& gap : pair.corner_gaps) gap = random.uniform(-most, most);
  }
};

TEST(Stacks, StandToRounding) {
  // Taller stacks run for less time, for equal work.
  for (const int count : {2, 5, 10, 18}) {
    Stack stack(std::vector<double>(static_cast<std::size_t>(count), kMass));
    stack.scene.prepare();
    stack.scene.run(20.0 / count);
    EXPECT_LT(computeDrift(stack.scene), kDrift) << count << " cubes";
    EXPECT_EQ(stack.scene.island.counters().resting_bodies, 0U);
    EXPECT_LT(stack.scene.factorisationsPerTick(), 1.01);
    EXPECT_EQ(stack.scene.relaxations, 0U);
  }
}

TEST(Stacks, StandWithAHeavyCube) {
  for (const double ratio : {25.0, 100.0})
    for (const bool is_on_top : {true, false})
      for (const std::size_t count : {std::size_t{2}, std::size_t{10}}) {
        std::vector<double> masses(count, kMass);
        (is_on_top ? masses.back() : masses.front()) *= ratio;
        Stack stack(masses);
        stack.scene.prepare();
        stack.scene.run(2.0);
        EXPECT_LT(computeDrift(stack.scene), kDrift)
            << count << " cubes, " << ratio << (is_on_top ? " on top" : " below");
        EXPECT_LT(stack.scene.factorisationsPerTick(), 1.01);
      }
}

// A finder's corners differ by rounding, always alike. The stack settles once and then stands.
TEST(Stacks, StandOnCornersThatDiffer) {
  constexpr double kGap = 5e-8;  // [m]
  for (const int count : {2, 5, 10, 18}) {
    test::Random random(kSeed);
    Stack stack(std::vector<double>(static_cast<std::size_t>(count), kMass));
    stack.setCornerGaps(random, kGap);
    stack.scene.prepare();
    stack.scene.run(0.2);
    // A gap tilts each cube by gap / width; all above go aside by that times their height.
    const double settled = computeDrift(stack.scene);
    EXPECT_LT(settled, kGap * count * count) << count << " cubes, seed " << kSeed;
    stack.scene.run(10.0 / count);
    EXPECT_NEAR(computeDrift(stack.scene), settled, 1e-9) << count << " cubes, seed " << kSeed;
    EXPECT_LT(stack.scene.factorisationsPerTick(), 1.1);
    EXPECT_LE(stack.scene.most_factorisations, 4U);
  }
}

// Bullet's narrowphase in float finds other corners in each search, to 6e-8 m.
TEST(Stacks, StandOnCornersThatJump) {
  constexpr double kGap = 6e-8;  // [m]
  for (const int count : {2, 5, 10, 18}) {
    test::Random random(kSeed);
    Stack stack(std::vector<double>(static_cast<std::size_t>(count), kMass));
    stack.scene.prepare();
    const int ticks = 10000 / count;
    for (int i = 0; i < ticks; ++i) {
      stack.setCornerGaps(random, kGap);
      stack.scene.advance();
    }
    // As above.
    EXPECT_LT(computeDrift(stack.scene), kGap * count * count) << count << " cubes, seed " << kSeed;
    EXPECT_LT(stack.scene.factorisationsPerTick(), 1.1);
    for (BodyIndex b = 0; b < count; ++b)
      EXPECT_LT(stack.scene.island.state(b).v_W.norm(), 1e-6) << "positions alone close gaps";
  }
}

// At 0.9 of the limit of friction, by turns in both directions, nothing may creep.
TEST(Stacks, DoNotCreepUnderACyclicPush) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr double kDuration = 20.0;                  // [s]
  constexpr double kCreep = 1e-6 / 60.0 * kDuration;  // 1 um a minute [m]
  for (const std::size_t count : {std::size_t{1}, std::size_t{3}}) {
    Stack stack(std::vector<double>(count, kMass));
    test::BoxScene& scene = stack.scene;
    scene.prepare();
    const double limit = scene.world.friction * static_cast<double>(count) * kMass * scene.gravity;
    for (int i = 0; i < static_cast<int>(kDuration / scene.tick); ++i) {
      scene.forces[0] = Vec3(0.9 * limit * std::sin(2.0 * kPi * i * scene.tick), 0, 0);
      scene.advance();
    }
    EXPECT_LT(computeDrift(scene), kCreep) << count << " cubes";
    EXPECT_EQ(scene.island.counters().resting_bodies, 0U);
  }
}

}  // namespace
}  // namespace tandem
