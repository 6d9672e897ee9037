// The hand of a gamepad in virtual time: its speed, its bounds, and walls.

#include "falcon/src/gamepad/gamepad_hand.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "simulated/mouse_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

constexpr GamepadState kRest{};
constexpr double kMaxForce = 8.0;   // [N]
constexpr double kHandForce = 6.0;  // three quarters of it [N]

/// Moves the hand at 1 kHz from the tick `begin` [ms] up to `end`, with no force.
DeviceSample moveFree(GamepadHand& hand, const GamepadState& state, int begin, int end,
                      bool is_held = false) {
  DeviceSample sample;
  for (int tick = begin; tick <= end; ++tick) {
    sample = hand.advance(tick * 1e-3, state, is_held);
    hand.write(Vec3::Zero());
  }
  return sample;
}

TEST(GamepadHand, AFullStickMovesItAtItsSpeed) {
  GamepadHand hand(GamepadSettings{});
  const DeviceSample first = moveFree(hand, {{1.0, 0.0, 0.0}, 0}, 0, 500);
  EXPECT_TRUE(first.valid);
  EXPECT_NEAR(first.hip.v_W.x(), 0.15, 1e-3);
  // It lags by 53 ms: 30 by smoothing, 16 by the cursor's glide, 7 by the handle's friction.
  EXPECT_NEAR(first.hip.p_W.x(), 0.15 * (0.5 - 0.053), 3e-4);
  EXPECT_NEAR(moveFree(hand, kRest, 501, 1500).hip.v_W.norm(), 0.0, 1e-6);
}

TEST(GamepadHand, ADeadZoneKeepsItStillAndNoStepFollows) {
  GamepadHand hand(GamepadSettings{});
  EXPECT_EQ(moveFree(hand, {{0.12, -0.12, 0.1}, 0}, 0, 500).hip.p_W, Vec3(Vec3::Zero()));
  const DeviceSample slow = moveFree(hand, {{0.131, 0.0, 0.0}, 0}, 501, 1500);
  EXPECT_NEAR(slow.hip.v_W.x(), 0.15 * 0.011 / 0.88, 1e-5);
}

TEST(GamepadHand, ItStaysInItsBox) {
  GamepadSettings settings;
  settings.start_W = Vec3(1.0, 2.0, 3.0);
  settings.workspace = Vec3(0.1, 0.05, 0.02);
  GamepadHand hand(settings);
  for (const bool is_held : {false, true}) {
    const DeviceSample end = moveFree(hand, {{1.0, 1.0, -1.0}, 0}, 0, 4000, is_held);
    EXPECT_LT((end.hip.p_W - Vec3(1.1, 2.05, 2.98)).norm(), 1e-6) << is_held;
  }
}

TEST(GamepadHand, SticksAreInTheUsersFrame) {
  GamepadSettings settings;
  settings.q_WD = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()));  // up is z
  GamepadHand hand(settings);
  const Vec3 v_W = moveFree(hand, {{0.0, 1.0, 0.0}, 0}, 0, 500).hip.v_W;
  EXPECT_LT((v_W - Vec3(0, 0, 0.15)).norm(), 1e-3);
}

TEST(GamepadHand, APlaceOfAStickIsAPlaceOfTheHand) {
  GamepadHand hand(GamepadSettings{});
  const DeviceSample aside = moveFree(hand, {{0.5, 0.0, -1.0}, 0}, 0, 1500, true);
  EXPECT_LT((aside.hip.p_W - Vec3(0.075, 0.0, -0.15)).norm(), 1e-6);
  const DeviceSample raised = moveFree(hand, {{0.5, 1.0, -1.0}, 0}, 1501, 2001, true);
  EXPECT_NEAR(raised.hip.v_W.y(), 0.15, 1e-3);
  EXPECT_LT((moveFree(hand, kRest, 2002, 4000, true).hip.p_W - Vec3(0, raised.hip.p_W.y(), 0)).x(),
            1e-6);
}

/// Pushes into a wall at x = 0 for two seconds, and returns the range of the force in the last.
std::pair<double, double> pushWall(GamepadHand& hand, const test::MouseWall& wall, bool is_held) {
  double least = 1e9, most = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const DeviceSample sample = hand.advance(tick * 1e-3, {{1.0, 0.0, 0.0}, 0}, is_held);
    const Vec3 f_W = wall.push(sample.hip);
    hand.write(f_W);
    if (tick < 1000) continue;
    least = std::min(least, f_W.norm());
    most = std::max(most, f_W.norm());
  }
  return {least, most};
}

TEST(GamepadHand, AWallHoldsItWithASteadyForceBelowTheLimit) {
  for (const double stiffness : {1000.0, 2000.0})
    for (const bool is_held : {false, true}) {
      SCOPED_TRACE(testing::Message() << stiffness << " N/m, held " << is_held);
      GamepadHand hand(GamepadSettings{});
      const auto [least, most] = pushWall(hand, {stiffness, 5.0}, is_held);
      EXPECT_NEAR(least, kHandForce, 0.02);
      EXPECT_NEAR(most, kHandForce, 0.02);
      EXPECT_LT(most, kMaxForce);
    }
}

/// Presses against a wall across `way_W` for two seconds and turns back. Returns the time until the
/// hand has left the wall [ms].
int measureWayBack(const Vec3& way_W, bool is_held) {
  GamepadHand hand(GamepadSettings{});
  for (int tick = 0; tick < 5000; ++tick) {
    const Vec3 sticks = tick < 2000 ? way_W : Vec3(-way_W);
    const DeviceSample sample =
        hand.advance(tick * 1e-3, {{sticks.x(), sticks.y(), sticks.z()}, 0}, is_held);
    const double depth = way_W.dot(sample.hip.p_W);
    if (tick > 2000 && depth < 0.0) return tick - 2000;
    hand.write(depth > 0.0 ? Vec3(-1000.0 * depth * way_W) : Vec3(Vec3::Zero()));
  }
  return 3000;
}

// Without a bound the target would be 0.28 m within the wall, and need two seconds to come back.
TEST(GamepadHand, ItDoesNotWindUpAgainstAWall) {
  EXPECT_LT(measureWayBack(Vec3::UnitX(), false), 300);
  EXPECT_LT(measureWayBack(-Vec3::UnitY(), false), 300);
  EXPECT_LT(measureWayBack(-Vec3::UnitY(), true), 300) << "a held stick, lowered by its hat";
}

// The target goes on by 20 ms, and the handle makes up for what it lagged behind by the glide.
TEST(GamepadHand, AfterASiteHasStoodItGoesOnFromWhereItWas) {
  GamepadHand hand(GamepadSettings{});
  const GamepadState full{{1.0, 0.0, 0.0}, 0};
  const Vec3 before = moveFree(hand, full, 0, 300).hip.p_W;
  EXPECT_LE((hand.advance(9.0, full, false).hip.p_W - before).norm(), 0.15 * (0.02 + 0.016));
}

TEST(GamepadHand, TimeThatMakesNoSenseMovesNothing) {
  GamepadHand hand(GamepadSettings{});
  const GamepadState full{{1.0, 0.0, 0.0}, 0};
  const Vec3 before = moveFree(hand, full, 0, 300).hip.p_W;
  for (const double now : {0.1, std::nan(""), -std::numeric_limits<double>::infinity()})
    EXPECT_EQ(hand.advance(now, full, false).hip.p_W, before) << now;
  EXPECT_GT(hand.advance(0.101, full, false).hip.p_W.x(), before.x()) << "and it goes on";
}

TEST(GamepadHand, WithoutADeviceItStands) {
  GamepadHand hand(GamepadSettings{});
  const Vec3 before = moveFree(hand, {{1.0, 0.0, 0.0}, 0}, 0, 300).hip.p_W;
  const DeviceSample gone = hand.stand(0.301);
  EXPECT_FALSE(gone.valid);
  EXPECT_EQ(gone.hip.p_W, before);
  EXPECT_EQ(gone.hip.v_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(gone.buttons, 0U);
}

TEST(GamepadHand, AnySticksAndForcesKeepItFinite) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    test::Random random(seed);
    GamepadHand hand(GamepadSettings{});
    for (int tick = 0; tick < 500; ++tick) {
      const Vec3 sticks = random.inCube(1.0);
      const GamepadState state{{sticks.x(), sticks.y(), sticks.z()}, 0};
      const DeviceSample sample = hand.advance(tick * 1e-3, state, random.below(2) == 0);
      ASSERT_TRUE(sample.valid && isFinite(sample.hip));
      ASSERT_LT(sample.hip.p_W.norm(), 1.0);
      hand.write(random.below(20) == 0 ? Vec3(Vec3::Constant(std::nan(""))) : random.inCube(20.0));
    }
  }
}

TEST(GamepadHand, RefusesSettingsOutOfRange) {
  const auto refuses = [](auto change) {
    GamepadSettings settings;
    change(settings);
    EXPECT_THROW(GamepadHand{settings}, std::invalid_argument);
  };
  refuses([](GamepadSettings& s) { s.speed = 0.0; });
  refuses([](GamepadSettings& s) { s.dead_zone = 1.0; });
  refuses([](GamepadSettings& s) { s.smoothing = -1.0; });
  refuses([](GamepadSettings& s) { s.travel = -0.1; });
  refuses([](GamepadSettings& s) { s.max_force = 0.0; });
  refuses([](GamepadSettings& s) { s.max_force = std::nan(""); });
  refuses([](GamepadSettings& s) { s.workspace.y() = 0.0; });
  refuses([](GamepadSettings& s) { s.start_W.x() = std::nan(""); });
  refuses([](GamepadSettings& s) { s.q_WD = Quat(0, 0, 0, 0); });
}

}  // namespace
}  // namespace tandem
