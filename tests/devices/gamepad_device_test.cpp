// A gamepad with its thread, on an input device in memory.

#include "tandem/falcon/gamepad_device.h"

#include <gtest/gtest.h>

#include "devices/fake_event_port.h"
#include "devices/fake_hid_port.h"

namespace tandem {
namespace {

using test::comesTrue;
using test::FakeEventDevice;

class GamepadDeviceTest : public testing::Test {
 protected:
  GamepadDeviceTest() { FakeEventDevice::makePad(fake_); }

  static GamepadSettings settings() {
    GamepadSettings settings;
    settings.first_retry = 0.001;
    return settings;
  }

  /// Writes `f_W` until the outcome is there, as a loop would.
  static bool comesTrueWith(GamepadDevice& device, const Vec3& f_W,
                            const std::function<bool()>& outcome) {
    return comesTrue([&] {
      device.write(f_W);
      return outcome();
    });
  }

  FakeEventDevice fake_;
};

TEST_F(GamepadDeviceTest, AStickMovesTheHandAndButtonsAreTold) {
  GamepadDevice device(fake_.opener(), settings());
  EXPECT_EQ(device.capabilities().name, "gamepad");
  EXPECT_EQ(device.capabilities().max_force, 8.0);
  (void)device.read(0.0);
  fake_.tell(EV_ABS, ABS_X, 32767);
  fake_.tell(EV_KEY, BTN_SOUTH, 1);
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == 2; }));
  DeviceSample sample;
  for (int tick = 1; tick <= 100; ++tick) sample = device.read(tick * 1e-3);
  EXPECT_TRUE(sample.valid);
  EXPECT_GT(sample.hip.v_W.x(), 0.1);
  EXPECT_EQ(sample.buttons, kSouthButton);
  EXPECT_EQ(device.buttons(), kSouthButton);
  EXPECT_EQ(device.status().name, "fake pad");
}

TEST_F(GamepadDeviceTest, AForceIsFeltAsRumbleThatEndsWithIt) {
  GamepadDevice device(fake_.opener(), settings());
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 4), [&] { return fake_.played().level == 0x8000; }));
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 8), [&] { return fake_.played().level == 0xFFFF; }));
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 0), [&] { return fake_.played().level == 0; }));
  EXPECT_EQ(fake_.created(), 1);
}

TEST_F(GamepadDeviceTest, AForceEndsWhenNobodyWritesAnyMore) {
  GamepadDevice device(fake_.opener(), settings());
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 4), [&] { return fake_.played().level > 0; }));
  EXPECT_TRUE(comesTrue([&] { return fake_.played().level == 0; }));
}

TEST_F(GamepadDeviceTest, AStickIsPushedInTheUsersFrame) {
  FakeEventDevice stick;
  FakeEventDevice::makeStick(stick);
  GamepadSettings turned = settings();
  turned.q_WD = Quat(Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()));  // away is y
  GamepadDevice device(stick.opener(), turned);
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 8, 0), [&] { return stick.played().level == 0x7FFF; }));
  EXPECT_EQ(stick.played().direction, 0) << "from the user's side";
}

TEST_F(GamepadDeviceTest, TheEffectIsErasedWithTheDevice) {
  {
    GamepadDevice device(fake_.opener(), settings());
    ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 4), [&] { return fake_.played().level > 0; }));
  }
  EXPECT_TRUE(fake_.effects().empty());
}

TEST_F(GamepadDeviceTest, UnpluggedItIsNotValidUntilItIsBack) {
  GamepadDevice device(fake_.opener(), settings());
  EXPECT_TRUE(device.read(0.0).valid);
  fake_.tell(EV_KEY, BTN_SOUTH, 1);
  fake_.setPluggedIn(false);
  ASSERT_TRUE(comesTrue([&] { return device.status().trouble == "the fake is not plugged in"; }));
  EXPECT_FALSE(device.read(0.1).valid);
  EXPECT_EQ(device.buttons(), 0U) << "nothing is held by a button that is gone";

  fake_.press(BTN_SOUTH, false);
  fake_.setPluggedIn(true);
  ASSERT_TRUE(comesTrue([&] { return device.status().is_connected; }));
  EXPECT_TRUE(device.read(0.2).valid);
  EXPECT_EQ(device.status().counters.losses, 1U);
  EXPECT_EQ(device.status().trouble, "");
  ASSERT_TRUE(comesTrueWith(device, Vec3(0, 0, 4), [&] { return fake_.played().level > 0; }));
}

TEST_F(GamepadDeviceTest, LostEventsAreReadAnew) {
  GamepadDevice device(fake_.opener(), settings());
  fake_.move(ABS_X, 32767);
  fake_.send({{EV_SYN, SYN_DROPPED, 0}, {EV_ABS, ABS_X, -5}, {EV_SYN, SYN_REPORT, 0}});
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == 1; }));
  EXPECT_EQ(device.status().state.sticks[0], 1.0);
  EXPECT_EQ(device.status().counters.dropped, 1U);
}

TEST_F(GamepadDeviceTest, RefusedUploadsAreCounted) {
  fake_.refuseUploads(true);
  GamepadDevice device(fake_.opener(), settings());
  ASSERT_TRUE(
      comesTrueWith(device, Vec3(0, 0, 4), [&] { return device.status().counters.refused > 1; }));
  EXPECT_TRUE(device.read(0.0).valid) << "the hand moves all the same";
}

TEST_F(GamepadDeviceTest, RefusesWhatHasNoStickOrIsNotThere) {
  FakeEventDevice keyboard;
  try {
    const GamepadDevice device(keyboard.opener(), settings());
    FAIL() << "a keyboard is no gamepad";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "fake pad has no stick; give a gamepad, see tandem device list");
  }
  fake_.setPluggedIn(false);
  EXPECT_THROW(GamepadDevice(fake_.opener(), settings()), Error);
  GamepadSettings bad = settings();
  bad.longest_retry = 0.0;
  EXPECT_THROW(GamepadDevice(fake_.opener(), bad), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
