// The effect that renders a force, and its way to a device.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "devices/fake_event_port.h"
#include "falcon/src/gamepad/feel_effect.h"
#include "falcon/src/gamepad/feel_player.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::FakeEventDevice;

constexpr double kMaxForce = 8.0;  // [N]

FeelEffect makeRumble(const Vec3& f_D) { return makeFeelEffect(Feel::kRumble, f_D, kMaxForce); }
FeelEffect makeForce(const Vec3& f_D) { return makeFeelEffect(Feel::kForce, f_D, kMaxForce); }

TEST(FeelEffect, RumbleIsTheShareOfTheGreatestForce) {
  EXPECT_EQ(makeRumble(Vec3(0, 0, 0)).level, 0);
  EXPECT_EQ(makeRumble(Vec3(0, -4, 0)).level, 0x8000);
  EXPECT_EQ(makeRumble(Vec3(0, 0, 8)).level, 0xFFFF);
  EXPECT_EQ(makeRumble(Vec3(1e300, 0, 0)).level, 0xFFFF);
  EXPECT_EQ(makeRumble(Vec3(0.07, 0, 0)).level, 0) << "below 1 %";
  EXPECT_EQ(makeRumble(Vec3(0.09, 0, 0)).level, 737);
}

// The kernel's level is signed: 65535 would be -1, a weak force the wrong way.
TEST(FeelEffect, TheLevelOfAForceStaysPositive) {
  EXPECT_EQ(makeForce(Vec3(8, 0, 0)).level, 0x7FFF);
  EXPECT_EQ(makeForce(Vec3(800, 0, 800)).level, 0x7FFF);
  EXPECT_EQ(makeForce(Vec3(4, 0, 0)).level, 0x4000);
  EXPECT_EQ(makeForce(Vec3(0, 5, 0)).level, 0) << "no stick pushes upwards";
}

TEST(FeelEffect, AForceComesFromTheOppositeSide) {
  EXPECT_EQ(makeForce(Vec3(0, 0, -3)).direction, 0x0000) << "away from the user";
  EXPECT_EQ(makeForce(Vec3(3, 0, 0)).direction, 0x4000) << "to the right";
  EXPECT_EQ(makeForce(Vec3(0, 0, 3)).direction, 0x8000) << "towards the user";
  EXPECT_EQ(makeForce(Vec3(-3, 0, 0)).direction, 0xC000) << "to the left";
  EXPECT_EQ(makeForce(Vec3(3, 2, -3)).direction, 0x2000);
}

TEST(FeelEffect, WhatIsNoForceGivesNone) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& f : {Vec3(nan, 0, 0), Vec3(0, 0, inf), Vec3(-inf, nan, 1)}) {
    EXPECT_EQ(makeRumble(f).level, 0);
    EXPECT_EQ(makeForce(f).level, 0);
  }
  EXPECT_EQ(makeFeelEffect(Feel::kNothing, Vec3(8, 8, 8), kMaxForce).level, 0);
}

/// The kernel's reading of an effect without memory: x to the right, y towards the user.
Vec3 readAsKernel(const FeelEffect& effect) {
  const double angle = effect.direction * 2.0 * std::acos(-1.0) / 0x10000;
  const double force = effect.level * kMaxForce / 0x7FFF;
  return {force * std::sin(angle), 0.0, -force * std::cos(angle)};
}

TEST(FeelEffect, TheKernelReadsBackTheForce) {
  test::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Vec3 f_D = random.inCube(5.0);
    f_D.y() = 0.0;
    if (f_D.norm() < 0.1) continue;
    EXPECT_LT((readAsKernel(makeForce(f_D)) - f_D).norm(), 1e-3);
  }
}

class FeelPlayerTest : public testing::Test {
 protected:
  FeelPlayerTest() { FakeEventDevice::makePad(device_); }

  FakeEventDevice device_;
  std::unique_ptr<EventPort> port_ = device_.open();
};

TEST_F(FeelPlayerTest, OneEffectIsUploadedAndUpdated) {
  FeelPlayer player(*port_);
  for (int i = 0; i < 1000; ++i) player.show(makeRumble(Vec3(1.0 + 0.005 * i, 0, 0)), 0.01 * i);
  EXPECT_EQ(device_.created(), 1);
  EXPECT_EQ(device_.updated(), 999);
  EXPECT_EQ(device_.effects().size(), 1U);
  EXPECT_EQ(device_.played().level, makeRumble(Vec3(5.995, 0, 0)).level);
}

TEST_F(FeelPlayerTest, ASteadyForceIsPlayedAnewBeforeItEnds) {
  FeelPlayer player(*port_);
  for (int i = 0; i < 1000; ++i) player.show(makeRumble(Vec3(4, 0, 0)), 0.01 * i);
  EXPECT_EQ(device_.updated(), 0);
  EXPECT_GE(device_.starts(), 20) << "10 s of an effect that lasts 1 s";
  EXPECT_LE(device_.starts(), 30) << "and no more than twice a second or so";
}

TEST_F(FeelPlayerTest, NoForceEndsIt) {
  FeelPlayer player(*port_);
  player.show(makeRumble(Vec3(4, 0, 0)), 0.0);
  EXPECT_GT(device_.played().level, 0);
  player.show(makeRumble(Vec3(0, 0, 0)), 0.01);
  EXPECT_EQ(device_.played().level, 0);
  player.show(makeRumble(Vec3(4, 0, 0)), 0.02);
  EXPECT_EQ(device_.played().level, 0x8000);
  EXPECT_EQ(device_.created(), 1);
}

TEST_F(FeelPlayerTest, TheEffectIsErasedAtTheEnd) {
  {
    FeelPlayer player(*port_);
    player.show(makeRumble(Vec3(4, 0, 0)), 0.0);
    EXPECT_EQ(device_.effects().size(), 1U);
  }
  EXPECT_TRUE(device_.effects().empty());
}

TEST_F(FeelPlayerTest, ARefusedUploadIsTriedAgainAndLeavesNothingPlaying) {
  FeelPlayer player(*port_);
  device_.refuseUploads(true);
  EXPECT_EQ(player.show(makeRumble(Vec3(4, 0, 0)), 0.0), FeelNews::kRefused);
  EXPECT_EQ(device_.played().level, 0);
  device_.refuseUploads(false);
  EXPECT_EQ(player.show(makeRumble(Vec3(4, 0, 0)), 0.01), FeelNews::kUploaded);
  EXPECT_EQ(device_.played().level, 0x8000);
  EXPECT_EQ(player.show(makeRumble(Vec3(4, 0, 0)), 0.02), FeelNews::kSame);
}

}  // namespace
}  // namespace tandem
