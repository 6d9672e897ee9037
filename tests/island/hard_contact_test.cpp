// Rigid contact where its laws are hard: a rod that jams, a block that rocks, a corner that
// bounces.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "island/box_scene.h"

namespace tandem {
namespace {

using test::BoxScene;

Vec3 cornerOf(const Vec3& half_extents, int i) {
  return {(i & 1) != 0 ? half_extents.x() : -half_extents.x(),
          (i & 2) != 0 ? half_extents.y() : -half_extents.y(),
          (i & 4) != 0 ? half_extents.z() : -half_extents.z()};
}

/// A box whose lowest corner is `gap` [m] above the floor.
RigidState placeAbove(const Vec3& half_extents, const Quat& q_WB, double gap) {
  double lowest = 0.0;
  for (int i = 0; i < 8; ++i) lowest = std::min(lowest, (q_WB * cornerOf(half_extents, i)).z());
  RigidState state;
  state.q_WB = q_WB;
  state.p_W.z() = gap - lowest;
  return state;
}

// Overlap of 5e-9 m at an impact moves out again, and lifts the weight: 1e-8 J of a rod of 0.2 kg.
TEST(HardContact, APainleveRodStaysFiniteAndGainsNoEnergy) {
  const Vec3 half(0.2, 0.005, 0.005);
  constexpr double kMass = 0.2, kLift = kMass * BoxScene::kGravity * 5e-9;
  for (const double friction : {1.5, 2.0, 3.0})
    for (const double angle : {0.7854, 1.2})
      for (const double speed : {-2.0, 2.0}) {
        BoxScene scene;
        RigidState start = placeAbove(half, Quat(Eigen::AngleAxisd(angle, Vec3::UnitY())), 0.0);
        start.v_W.x() = speed;
        scene.add(half, kMass, start);
        scene.world.friction = friction;
        scene.prepare();
        double energy = scene.energy();
        for (int i = 0; i < 1000; ++i) {
          scene.advance();
          ASSERT_TRUE(scene.isFinite());
          // Two impacts a tick, at each of two corners.
          EXPECT_LT(scene.energy(), energy + 4.0 * kLift)
              << "friction " << friction << " angle " << angle << " speed " << speed << " tick "
              << i;
          energy = scene.energy();
        }
        EXPECT_LE(scene.most_steps, 24U);
        EXPECT_LT(scene.stepsPerTick(), 1.6);
      }
}

// One corner alone would turn it out of its plane, though the other is nanometres away.
TEST(HardContact, AnEdgeThatRoundingTiltsLandsWhole) {
  const Vec3 half(0.02, 0.02, 0.02);
  for (const double tilt : {0.0, 1e-9, 1e-8, 1e-7, 1e-6}) {
    BoxScene scene;
    const Quat edge(Eigen::AngleAxisd(0.5, Vec3::UnitY()));
    const Quat roll(Eigen::AngleAxisd(tilt, Vec3::UnitX()));
    scene.add(half, 0.2, placeAbove(half, roll * edge, 1e-3));
    scene.prepare();
    for (int i = 0; i < 30; ++i) {
      scene.advance();
      const Vec3& w_W = scene.island.state(0).w_W;
      ASSERT_LT(std::hypot(w_W.x(), w_W.z()), 1e-4 + 100.0 * tilt) << tilt << " tick " << i;
    }
    EXPECT_GT(std::abs(scene.island.state(0).w_W.y()), 1.0);
  }
}

// Its corners are nearer to each other than points of contact may wander: one that is about to
// touch was taken for the one that does, a step before, and the cube sped up.
TEST(HardContact, ATinyCubeTumblesAndGainsNoEnergy) {
  constexpr std::uint32_t kSeed = 717171;
  SCOPED_TRACE(kSeed);
  std::mt19937 draw(kSeed);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  for (int i = 0; i < 40; ++i) {
    const double size = std::pow(10.0, -3.3 + 0.3 * part(draw));
    const Vec3 half(size, size, size);
    const double turn = part(draw), x = part(draw), y = part(draw), speed = 0.1 * part(draw);
    RigidState start =
        placeAbove(half, Quat(Eigen::AngleAxisd(turn, Vec3(x, y, 0.3).normalized())), size);
    start.v_W = Vec3(speed, 0.5 * speed, 0.0);
    constexpr double kMass = 0.5;
    BoxScene scene;
    scene.add(half, kMass, start);
    scene.world.friction = 0.85;
    scene.prepare();
    const double lowest = kMass * BoxScene::kGravity * size;
    const double all = scene.energy() - lowest;
    double gained = 0.0, energy = scene.energy();
    for (int tick = 0; tick < 300; ++tick) {
      scene.advance();
      gained += std::max(0.0, scene.energy() - energy);
      energy = scene.energy();
    }
    EXPECT_LT(gained, 1e-3 * all) << "cube " << i << " of " << size << " m";
  }
}

// As a body that stands in a float's host, or that Bullet left in its own tolerance, and that gets
// a velocity: the step of its impact was not shortened, and it sank by all of its way.
TEST(HardContact, AFastBodyThatOverlapsALittleSinksNoFarther) {
  const Vec3 half = Vec3::Constant(0.02);
  for (const double overlap : {0.0, 5e-9, 3e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3})
    for (const double speed : {0.01, 1.0, 10.0}) {
      BoxScene scene;
      RigidState start = placeAbove(half, Quat::Identity(), -overlap);
      start.v_W = Vec3(0.3, 0.0, -speed);
      scene.add(half, 0.2, start);
      scene.prepare();
      for (int i = 0; i < 20; ++i) {
        scene.advance();
        const double depth = half.z() - scene.island.state(0).p_W.z();
        ASSERT_LT(depth, overlap + 2e-8) << overlap << " m, " << speed << " m/s, tick " << i;
      }
      EXPECT_LE(scene.most_steps, 16U) << overlap << " m, " << speed << " m/s";
    }
}

// Each impact of a rocking block takes the same share of its energy (Housner 1963):
// w+ / w- = 1 - 3/2 sin^2 a, tan a = width / height.
TEST(HardContact, ARockingBlockLosesHousnersShare) {
  const Vec3 half(0.02, 0.02, 0.1);
  constexpr double kMass = 0.4;
  const double ratio = 1.0 - 1.5 * std::pow(std::sin(std::atan2(half.x(), half.z())), 2);
  for (const double tilt : {0.1, 0.15}) {
    BoxScene scene;
    scene.add(half, kMass, placeAbove(half, Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY())), 0.0));
    scene.world.friction = 1.0;
    scene.prepare();
    const double upright = kMass * BoxScene::kGravity * half.z();
    const double start = scene.energy() - upright;
    double energy = start;
    int impacts = 0;
    for (int i = 0; i < 3000; ++i) {
      scene.advance();
      const double now = scene.energy() - upright;
      EXPECT_LT(now, energy + 1e-8) << "overlap of 5e-9 m, moved out";
      if (now < 0.95 * energy && ++impacts <= 3) {
        EXPECT_NEAR(now / energy, ratio * ratio, 1e-4) << "tilt " << tilt << " tick " << i;
      }
      energy = now;
    }
    EXPECT_GE(impacts, 3);
    EXPECT_LE(scene.most_steps, 16U);
    EXPECT_LT(scene.stepsPerTick(), 1.1);
  }
}

// u+ = -e u- where the body touches. Without weight a cube flies and turns steadily, so that the
// velocities at the impact follow from those of the ticks around it.
TEST(HardContact, ACornerBouncesWithItsRestitution) {
  const Vec3 half = Vec3::Constant(0.02);
  for (const double restitution : {0.0, 0.5, 1.0}) {
    BoxScene scene;
    const Quat q_WB(Eigen::AngleAxisd(0.6, Vec3(1.0, 0.3, 0.2).normalized()));
    RigidState before = placeAbove(half, q_WB, 1.23e-3);
    before.v_W = Vec3(0.1, 0.0, -0.5);
    before.w_W = Vec3(0.5, 0.2, 0.0);
    Vec3 corner_B = cornerOf(half, 0);
    for (int i = 0; i < 8; ++i)
      if ((q_WB * cornerOf(half, i)).z() < (q_WB * corner_B).z()) corner_B = cornerOf(half, i);
    scene.add(half, 0.2, before);
    scene.world.friction = 0.0;
    scene.world.restitution = restitution;
    scene.gravity = 0.0;
    scene.prepare();
    scene.run(3e-3);
    const RigidState& after = scene.island.state(0);
    // The moment when the corner touches, by bisection.
    const auto armAt = [&](double time) {
      const Vec3 turn_W = time * before.w_W;
      return Vec3(Eigen::AngleAxisd(turn_W.norm(), turn_W.normalized()) * (q_WB * corner_B));
    };
    double early = 0.0, late = 3e-3;
    for (int i = 0; i < 60; ++i) {
      const double time = 0.5 * (early + late);
      (before.p_W.z() + time * before.v_W.z() + armAt(time).z() > 0.0 ? early : late) = time;
    }
    const Vec3 arm = armAt(early);
    const double u_before = (before.v_W + before.w_W.cross(arm)).z();
    const double u_after = (after.v_W + after.w_W.cross(arm)).z();
    // The impact comes up to 1e-8 s late.
    EXPECT_NEAR(u_after, -restitution * u_before, 1e-6) << "restitution " << restitution;
  }
}

}  // namespace
}  // namespace tandem
