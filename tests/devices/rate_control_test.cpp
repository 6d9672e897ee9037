#include "falcon/src/hid/rate_control.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace tandem {
namespace {

/// Settings: no dead zone, 0.1 m/s, 20 ms, a box of 1 m.
RateControlSettings makePlain() {
  RateControlSettings settings;
  settings.speed = 0.1;
  settings.dead_zone = 0.0;
  settings.smoothing = 0.02;
  settings.workspace = Vec3::Constant(1.0);
  return settings;
}

TEST(RateControl, FollowsTheExactMapHoweverItIsAsked) {
  for (const int steps : {1, 7, 250}) {
    RateControl control(makePlain());
    control.setDisplacement(Vec3(1, -0.5, 0));
    for (int i = 0; i < steps; ++i) control.advance(0.05 / steps);
    const double decay = std::exp(-0.05 / 0.02);
    EXPECT_NEAR(control.point().v_W.x(), 0.1 * (1 - decay), 1e-15) << steps;
    EXPECT_NEAR(control.point().p_W.x(), 0.1 * (0.05 - 0.02 * (1 - decay)), 1e-15) << steps;
    EXPECT_NEAR(control.point().p_W.y(), -0.5 * control.point().p_W.x(), 1e-15) << steps;
    EXPECT_EQ(control.point().p_W.z(), 0.0);
  }
}

TEST(RateControl, StepsOfTheCapMakeNoStepOfTheVelocity) {
  RateControl control(makePlain());
  double last = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    if (tick % 8 == 0) control.setDisplacement(Vec3(tick % 16 == 0 ? 1 : -1, 0, 0));
    control.advance(1e-3);
    const double v = control.point().v_W.x();
    // The change is at most the whole range of 0.2 m/s, decaying with the time constant.
    ASSERT_LE(std::abs(v - last), 0.2 * 1e-3 / 0.02);
    last = v;
  }
}

TEST(RateControl, TheDeadZoneIsStillAndHasNoEdge) {
  RateControlSettings settings = makePlain();
  settings.dead_zone = 0.25;
  RateControl control(settings);
  const auto finalSpeed = [&](double part) {
    control.setDisplacement(Vec3(part, 0, 0));
    control.advance(0.9);
    const double v = control.point().v_W.x();
    control.stop();
    return v;
  };
  EXPECT_EQ(finalSpeed(0.25), 0.0);
  EXPECT_EQ(finalSpeed(-0.2), 0.0);
  EXPECT_NEAR(finalSpeed(0.2500001), 0.0, 1e-7);
  EXPECT_NEAR(finalSpeed(0.625), 0.05, 1e-12);
  EXPECT_NEAR(finalSpeed(-1.0), -0.1, 1e-12);
  EXPECT_NEAR(finalSpeed(7.0), 0.1, 1e-12) << "beyond full is full";
}

TEST(RateControl, StaysInItsBoxAndStandsAtTheWall) {
  RateControlSettings settings = makePlain();
  settings.start_W = Vec3(5, 0, 0);
  settings.workspace = Vec3(0.01, 1, 1);
  RateControl control(settings);
  control.setDisplacement(Vec3(1, 1, 0));
  for (int i = 0; i < 1000; ++i) control.advance(1e-3);
  EXPECT_EQ(control.point().p_W.x(), 5.01);
  EXPECT_EQ(control.point().v_W.x(), 0.0);
  EXPECT_NEAR(control.point().v_W.y(), 0.1, 1e-12) << "it slides along";
  control.setDisplacement(Vec3(-1, 0, 0));
  control.advance(0.01);
  EXPECT_LT(control.point().p_W.x(), 5.01);
}

TEST(RateControl, TurnsIntoTheWorld) {
  RateControlSettings settings = makePlain();
  settings.q_WD = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitZ()));
  RateControl control(settings);
  control.setDisplacement(Vec3(1, 0, 0));
  control.advance(1.0);
  EXPECT_NEAR(control.point().v_W.y(), 0.1, 1e-12);
  EXPECT_NEAR(control.point().v_W.x(), 0.0, 1e-12);
}

TEST(RateControl, BadNumbersMoveNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  RateControl control(makePlain());
  control.setDisplacement(Vec3(kNan, 1, 1));
  control.advance(1.0);
  control.setDisplacement(Vec3(1, 1, 1));
  for (const double interval : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()})
    control.advance(interval);
  EXPECT_EQ(control.point().p_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(control.point().v_W, Vec3(Vec3::Zero()));
}

TEST(RateControl, RefusesSettingsOutOfRange) {
  const auto expectRefused = [](auto spoil) {
    RateControlSettings settings;
    spoil(settings);
    EXPECT_THROW((void)RateControl(settings), std::invalid_argument);
  };
  using S = RateControlSettings;
  expectRefused([](S& s) { s.speed = 0.0; });
  expectRefused([](S& s) { s.dead_zone = 1.0; });
  expectRefused([](S& s) { s.dead_zone = -0.1; });
  expectRefused([](S& s) { s.smoothing = 0.0; });
  expectRefused([](S& s) { s.start_W.x() = std::numeric_limits<double>::infinity(); });
  expectRefused([](S& s) { s.workspace.z() = 0.0; });
  expectRefused([](S& s) { s.q_WD = Quat(2, 0, 0, 0); });
}

TEST(RateControl, TurnsAWristHoweverItIsAsked) {
  for (const int steps : {1, 7, 250}) {
    RateControlSettings settings = makePlain();
    settings.turn_speed = 2.0;
    RateControl control(settings);
    control.setDisplacement(Vec3::Zero(), Vec3(0, 0.5, 0));
    for (int i = 0; i < steps; ++i) control.advance(0.05 / steps);
    const double decay = std::exp(-0.05 / 0.02), angle = 0.05 - 0.02 * (1 - decay);
    ASSERT_TRUE(control.wrist());
    EXPECT_NEAR(control.wrist()->w_W.y(), 1 - decay, 1e-14) << steps;
    EXPECT_LT(control.wrist()->q_WH.angularDistance(Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()))),
              1e-7);
    control.stop();
    EXPECT_EQ(control.wrist()->w_W, Vec3::Zero());
  }
  RateControlSettings settings = makePlain();
  settings.turn_speed = 0.0;
  EXPECT_FALSE(RateControl(settings).wrist());
}

}  // namespace
}  // namespace tandem
