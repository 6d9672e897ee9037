#include "tandem/falcon/mouse_device.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "simulated/mouse_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::readFree;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool isEqual(const PointState& a, const PointState& b) { return a.p_W == b.p_W && a.v_W == b.v_W; }

TEST(MouseDevice, TellsItsCapabilities) {
  const MouseDevice mouse;
  EXPECT_EQ(mouse.capabilities().name, "mouse");
  EXPECT_EQ(mouse.capabilities().degrees_of_freedom, 3);
  EXPECT_EQ(mouse.capabilities().max_force, 10.0);
  EXPECT_EQ(mouse.capabilities().workspace, Vec3(0.4, 0.4, 0.4));
  EXPECT_FALSE(mouse.capabilities().is_continuous);
}

TEST(MouseDevice, RestsAtItsStartUntilItIsMoved) {
  MouseSettings settings;
  settings.start_W = Vec3(0.1, -0.2, 0.3);
  MouseDevice mouse(settings);
  EXPECT_EQ(mouse.target(), settings.start_W);
  EXPECT_EQ(mouse.view().handle_W, settings.start_W) << "before the first read";
  EXPECT_EQ(mouse.view().cursor_W, settings.start_W);
  const DeviceSample sample = readFree(mouse, 0, 100);
  EXPECT_TRUE(sample.valid);
  EXPECT_EQ(sample.hip.p_W, settings.start_W);
  EXPECT_EQ(sample.hip.v_W, Vec3(Vec3::Zero()));
  EXPECT_FALSE(sample.wrist);
}

TEST(MouseDevice, ComesToRestAtItsTarget) {
  MouseDevice mouse;
  const Vec3 target_W(0.03, -0.02, 0.01);
  ASSERT_TRUE(mouse.moveTo(target_W, 0.0));
  // The swing fades with the time constant 2 m / (B + b) = 20 ms: 100 of them in 2 s.
  const DeviceSample sample = readFree(mouse, 0, 2000);
  EXPECT_LT((sample.hip.p_W - target_W).norm(), 1e-12);
  EXPECT_EQ(mouse.view().cursor_W, target_W);
  EXPECT_FALSE(mouse.view().is_slack);
}

// The cursor.

TEST(MouseDevice, CursorGlidesToItsTargetInAStraightLine) {
  MouseDevice mouse;
  ASSERT_TRUE(mouse.moveTo(Vec3(0.01, 0.02, 0.0), 7.0));  // the first glide takes 50 ms
  for (int tick = 0; tick <= 50; ++tick) {
    (void)readFree(mouse, tick, tick);
    const Vec3 expected_W = tick / 50.0 * Vec3(0.01, 0.02, 0.0);
    EXPECT_LT((mouse.view().cursor_W - expected_W).norm(), 1e-15) << tick;
  }
  (void)readFree(mouse, 51, 51);
  EXPECT_EQ(mouse.view().cursor_W, Vec3(0.01, 0.02, 0.0));
}

TEST(MouseDevice, GlideTakesAQuarterLongerThanTheLastInterval) {
  struct Case {
    double interval, glide;  // [s]
  };
  for (const Case& c : {Case{0.0, 0.016}, Case{0.001, 0.016}, Case{0.024, 0.030},
                        Case{0.040, 0.050}, Case{3.0, 0.050}}) {
    MouseDevice mouse;
    ASSERT_TRUE(mouse.moveTo(Vec3(0.0, 0, 0), 1.0));
    ASSERT_TRUE(mouse.moveTo(Vec3(0.1, 0, 0), 1.0 + c.interval));
    const int half = static_cast<int>(std::lround(500.0 * c.glide));
    (void)readFree(mouse, 0, half);
    EXPECT_NEAR(mouse.view().cursor_W.x(), 0.05, 1e-12) << c.interval;
    (void)readFree(mouse, half + 1, 2 * half + 1);
    EXPECT_EQ(mouse.view().cursor_W.x(), 0.1) << c.interval;
  }
}

TEST(MouseDevice, CursorThatIsSentElsewhereInAGlideDoesNotJump) {
  const std::uint64_t seed = 4;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  MouseDevice mouse;
  double time = 0.0;
  Vec3 last_W = Vec3::Zero();
  for (int tick = 0; tick < 3000; ++tick) {
    if (random.below(5) == 0) (void)mouse.moveTo(random.inCube(0.2), time += 0.003);
    (void)readFree(mouse, tick, tick);
    const Vec3 cursor_W = mouse.view().cursor_W;
    // The longest way, the cube's diagonal of 693 mm, takes 16 ms at least.
    ASSERT_LT((cursor_W - last_W).norm(), 0.693 / 16.0 + 1e-12) << tick;
    last_W = cursor_W;
  }
}

TEST(MouseDevice, OnlyTheNewestOfSeveralTargetsCounts) {
  MouseDevice mouse, other;
  ASSERT_TRUE(mouse.moveTo(Vec3(0.1, 0.1, 0.1), 1.0));
  ASSERT_TRUE(mouse.moveTo(Vec3(0.2, 0, 0), 1.5));
  ASSERT_TRUE(other.moveTo(Vec3(0.2, 0, 0), 0.0));
  EXPECT_EQ(mouse.target(), Vec3(0.2, 0, 0));
  EXPECT_TRUE(isEqual(readFree(mouse, 0, 30).hip, readFree(other, 0, 30).hip)) << "both in 50 ms";
}

// The hand's limit.

TEST(MouseDevice, CursorThatJumpsFarPullsWithTheHandsLimit) {
  MouseSettings settings;
  settings.handle_damping = 0.0;
  MouseDevice mouse(settings);
  ASSERT_TRUE(mouse.moveTo(Vec3(0.4, 0, 0), 0.0));
  double last_speed = 0.0;
  for (int tick = 0; tick <= 2000; ++tick) {
    const double speed = readFree(mouse, tick, tick).hip.v_W.x();
    // 8 N on 0.1 kg are 80 mm/s in a millisecond.
    ASSERT_LT(std::abs(speed - last_speed), 0.080 + 1e-12) << tick;
    last_speed = speed;
    ASSERT_TRUE(mouse.view().is_slack || tick != 25);
  }
  EXPECT_FALSE(mouse.view().is_slack);
  EXPECT_NEAR(mouse.view().handle_W.x(), 0.4, 1e-9);
}

TEST(MouseDevice, IsSlackWhenTheBandIsLongerThanItsLimit) {
  for (const double force : {7.9, 8.1}) {
    MouseDevice mouse;
    // The hand holds 7.9 N. Against 8.1 N it pulls with 8 N and the handle creeps away.
    for (int tick = 0; tick <= 1500; ++tick) {
      (void)mouse.read(tick * 1e-3);
      mouse.write(Vec3(0, 0, -force));
    }
    EXPECT_EQ(mouse.view().is_slack, force > 8.0) << force;
  }
}

TEST(MouseDevice, ShowsTheForceWithinItsLimit) {
  MouseDevice mouse;
  (void)mouse.read(0.0);
  mouse.write(Vec3(1, -2, 3));
  EXPECT_EQ(mouse.view().force_W, Vec3(1, -2, 3));
  mouse.write(Vec3(0, 0, 50));
  EXPECT_EQ(mouse.view().force_W, Vec3(0, 0, 10));
  for (const double bad : {kNan, kInfinity}) {
    mouse.write(Vec3(0, bad, 0));
    EXPECT_EQ(mouse.view().force_W, Vec3(Vec3::Zero())) << bad;
    EXPECT_TRUE(mouse.read(0.001).valid) << bad;
  }
}

// Refusals.

TEST(MouseDevice, RefusedTargetsLeaveEverythingAsItWas) {
  MouseSettings settings;
  settings.start_W = Vec3(0.1, 0, 0);
  settings.workspace = 0.2;
  MouseDevice mouse(settings), untouched(settings);
  const Vec3 good_W(0.15, 0.1, 0);
  for (MouseDevice* each : {&mouse, &untouched}) ASSERT_TRUE(each->moveTo(good_W, 1.0));

  for (const double bad : {kNan, kInfinity, -kInfinity, 1e308, -1e200}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 target_W = good_W;
      target_W[axis] = bad;
      EXPECT_FALSE(mouse.moveTo(target_W, 1.02)) << bad;
    }
  }
  EXPECT_FALSE(mouse.moveTo(Vec3(0.301, 0, 0), 1.02)) << "too far";
  EXPECT_FALSE(mouse.moveTo(Vec3(-0.101, 0, 0), 1.02)) << "too far";
  EXPECT_FALSE(mouse.moveTo(Vec3(0.1, 0.15, 0.15), 1.02)) << "too far across";
  EXPECT_FALSE(mouse.moveTo(Vec3(0.1, 0, 0), 0.999)) << "runs back";
  for (const double bad : {kNan, kInfinity, -kInfinity})
    EXPECT_FALSE(mouse.moveTo(Vec3(0.1, 0, 0), bad)) << bad;

  EXPECT_EQ(mouse.target(), good_W);
  EXPECT_TRUE(isEqual(readFree(mouse, 0, 60).hip, readFree(untouched, 0, 60).hip));
  // Nor does a refused time count for the next glide.
  for (MouseDevice* each : {&mouse, &untouched}) ASSERT_TRUE(each->moveTo(Vec3(0, 0, 0), 1.024));
  EXPECT_TRUE(isEqual(readFree(mouse, 61, 80).hip, readFree(untouched, 61, 80).hip));
}

TEST(MouseDevice, TakesTargetsUpToTheEdgeOfItsWorkspace) {
  MouseDevice mouse;
  EXPECT_TRUE(mouse.moveTo(Vec3(0, 0, 0.4), 0.0));
  EXPECT_TRUE(mouse.moveTo(Vec3(0, 0, -0.4), 0.0)) << "a time that stands still";
  EXPECT_FALSE(mouse.moveTo(Vec3(0, 0, std::nextafter(0.4, 1.0)), 0.0));
  EXPECT_TRUE(mouse.reach().contains(Vec3(0.4, 0, 0)));
}

TEST(MouseDevice, HoldsItsTargetUntilItIsReleased) {
  MouseDevice mouse;
  ASSERT_TRUE(mouse.moveTo(Vec3(0.05, 0, 0), 0.0));
  mouse.hold();
  EXPECT_TRUE(mouse.isHeld());
  EXPECT_FALSE(mouse.moveTo(Vec3(0.1, 0, 0), 0.01));
  EXPECT_EQ(mouse.target(), Vec3(0.05, 0, 0));
  // A hand that holds resists: 6 N stretch the band by 20 mm, and it comes back.
  for (int tick = 0; tick <= 1000; ++tick) {
    (void)mouse.read(tick * 1e-3);
    mouse.write(Vec3(-6, 0, 0));
  }
  EXPECT_NEAR(mouse.view().handle_W.x(), 0.03, 1e-6);
  EXPECT_NEAR(readFree(mouse, 1001, 2000).hip.p_W.x(), 0.05, 1e-9);
  mouse.release();
  EXPECT_FALSE(mouse.isHeld());
  EXPECT_TRUE(mouse.moveTo(Vec3(0.1, 0, 0), 0.02));
}

// Time.

TEST(MouseDevice, FirstReadBeginsTheTimeOfTheHandle) {
  const double begin = 4096.0;  // [s]; a clock since the machine's start
  MouseDevice early, late;
  for (MouseDevice* each : {&early, &late}) ASSERT_TRUE(each->moveTo(Vec3(0.1, 0, 0), 20.0));
  for (int tick = 0; tick < 100; ++tick) {
    const double t = tick / 1024.0;  // exact on both clocks
    ASSERT_TRUE(isEqual(early.read(t).hip, late.read(begin + t).hip)) << tick;
  }
}

TEST(MouseDevice, AfterAPauseTheHandleGoesOnFromWhereItWas) {
  MouseDevice mouse, steady;
  for (MouseDevice* each : {&mouse, &steady}) {
    ASSERT_TRUE(each->moveTo(Vec3(0.1, 0, 0), 0.0));
    (void)each->read(0.0);
    (void)each->read(0.03125);
  }
  // An hour counts as 50 ms.
  const PointState paused = mouse.read(3600.0).hip, expected = steady.read(0.08125).hip;
  EXPECT_LT((paused.p_W - expected.p_W).norm(), 1e-9);
  EXPECT_LT((paused.v_W - expected.v_W).norm(), 1e-9);
}

TEST(MouseDevice, TimeOfReadsThatStandsStillOrRunsBackMovesNothing) {
  MouseDevice mouse;
  EXPECT_TRUE(mouse.read(kNan).valid) << "before the first read";
  ASSERT_TRUE(mouse.moveTo(Vec3(0.1, 0, 0), 0.0));
  const PointState before = readFree(mouse, 0, 20).hip;
  for (const double now : {0.020, 0.010, kNan, kInfinity, -kInfinity, -1.0}) {
    const DeviceSample sample = mouse.read(now);
    EXPECT_TRUE(sample.valid) << now;
    EXPECT_TRUE(isEqual(sample.hip, before)) << now;
  }
  EXPECT_GT(mouse.read(-0.999).hip.p_W.x(), before.p_W.x()) << "goes on by the new clock";
}

TEST(MouseDevice, EqualCallsGiveEqualBits) {
  const auto run = [] {
    test::Random random(77);
    MouseDevice mouse;
    PointState hip;
    for (int tick = 0; tick < 2000; ++tick) {
      const double t = tick * 1e-3;
      if (random.below(10) == 0) (void)mouse.moveTo(random.inCube(0.25), t);
      hip = mouse.read(t).hip;
      mouse.write(random.inCube(10.0));
    }
    return hip;
  };
  EXPECT_TRUE(isEqual(run(), run()));
}

// Settings.

std::string refusalOf(void (*change)(MouseSettings&)) {
  MouseSettings settings;
  change(settings);
  try {
    const MouseDevice mouse(settings);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MouseDevice, RefusesBadSettingsByName) {
  struct Case {
    void (*change)(MouseSettings&);
    const char* begins;
  };
  using S = MouseSettings;
  const Case cases[] = {
      {[](S& s) { s.mass = 0.0; }, "mass of the mouse is 0,"},
      {[](S& s) { s.mass = kInfinity; }, "mass of the mouse is inf,"},
      {[](S& s) { s.mass = 1e-6; }, "stiffness of the mouse is 300, must be above 0 and at most"},
      {[](S& s) { s.stiffness = 0.0; }, "stiffness of the mouse is 0,"},
      {[](S& s) { s.stiffness = 2e6; }, "stiffness of the mouse is 2e+06,"},
      {[](S& s) { s.stiffness = kNan; }, "stiffness of the mouse is nan,"},
      {[](S& s) { s.damping = -1.0; }, "damping of the mouse is -1,"},
      {[](S& s) { s.damping = 500.0; }, "damping of the mouse is 500,"},
      {[](S& s) { s.handle_damping = -0.5; }, "handle_damping of the mouse is -0.5,"},
      {[](S& s) { s.hand_force = 0.0; }, "hand_force of the mouse is 0,"},
      {[](S& s) { s.max_force = kInfinity; }, "max_force of the mouse is inf,"},
      {[](S& s) { s.shortest_glide = 0.0; }, "shortest_glide of the mouse is 0,"},
      {[](S& s) { s.longest_glide = 0.01; }, "longest_glide of the mouse is 0.01,"},
      {[](S& s) { s.start_W.z() = kNan; }, "start_W of the mouse is [0, 0, nan],"},
      {[](S& s) { s.workspace = -0.4; }, "workspace of the mouse is -0.4,"},
  };
  for (const Case& c : cases) {
    const std::string text = refusalOf(c.change);
    EXPECT_EQ(text.rfind(c.begins, 0), 0U) << c.begins << " in: " << text;
  }
  EXPECT_EQ(refusalOf([](S& s) { s.damping = 0.0; }), "accepted");
}

// The bounds of the settings leave the handle stable, without friction of its own too.
TEST(MouseDevice, StiffestHandComesToRest) {
  MouseSettings settings;
  settings.stiffness = 1.6e6;
  settings.damping = 400.0;
  settings.handle_damping = 0.0;
  settings.hand_force = 1e9;
  MouseDevice mouse(settings);
  ASSERT_TRUE(mouse.moveTo(Vec3(0.1, 0, 0), 0.0));
  EXPECT_NEAR(readFree(mouse, 0, 1000).hip.p_W.x(), 0.1, 1e-9);
}

}  // namespace
}  // namespace tandem
