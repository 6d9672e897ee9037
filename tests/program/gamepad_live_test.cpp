// A gamepad with all layers between it and a site, on an input device in memory.

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tandem/falcon/gamepad_device.h"
#include "tandem/falcon/monotonic_clock.h"

#include "demos/program/device/gamepad_driver.h"
#include "demos/program/device/live_device.h"
#include "demos/program/device/user_axes.h"
#include "devices/fake_event_port.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 20.0;  // longest wait for any outcome [s]

class GamepadLive : public ::testing::Test {
 protected:
  void open(const DeviceOptions& options) {
    test::FakeEventDevice::makePad(pad_);
    device_ = std::make_unique<LiveDevice>(
        DeviceSpec{DeviceSpec::Kind::kGamepad, ""}, makeGamepadDriver(pad_.opener(), options),
        options, Placement{computeUserAxes(Quat::Identity(), 0), kCentre_W});
    ASSERT_TRUE(readUntil([](const DeviceSample& sample) { return sample.valid; }));
  }
  /// Reads, and writes `f_W`, until it is so.
  bool readUntil(const std::function<bool(const DeviceSample&)>& is_so,
                 const Vec3& f_W = Vec3::Zero()) {
    for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
         sleepFor(1e-3)) {
      const DeviceSample sample = device_->read(0.0);
      device_->write(f_W);
      if (is_so(sample)) return true;
    }
    return false;
  }

  const Vec3 kCentre_W = Vec3(1.0, 2.0, 3.0);
  test::FakeEventDevice pad_;
  std::unique_ptr<LiveDevice> device_;
};

TEST_F(GamepadLive, TheStickMovesTheHandAwayFromTheUser) {
  open({});
  pad_.tell(EV_ABS, ABS_Y, -32768);
  EXPECT_TRUE(readUntil([&](const DeviceSample& sample) {
    const Vec3 way_W = sample.hip.p_W - kCentre_W;
    return way_W.x() > 0.02 && std::abs(way_W.y()) < 1e-4 && std::abs(way_W.z()) < 1e-4;
  }));
  pad_.tell(EV_ABS, ABS_Y, 0);
  pad_.tell(EV_ABS, ABS_RY, -32768);
  EXPECT_TRUE(readUntil(
      [&](const DeviceSample& sample) { return sample.hip.p_W.z() > kCentre_W.z() + 0.02; }));
}

TEST_F(GamepadLive, FullRumbleIsTheForceThatTheUserAllows) {
  DeviceOptions options;
  options.max_force = 2.0;
  open(options);
  EXPECT_EQ(device_->capabilities().max_force, 2.0);
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return pad_.played().level == 0xFFFF; },
                        Vec3(-5, 0, 0)));
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return pad_.played().level == 0; }));
}

TEST_F(GamepadLive, TheSouthButtonHoldsThingsUnlessAnotherIsGiven) {
  open({});
  EXPECT_TRUE(device_->hasGrip());
  pad_.tell(EV_KEY, BTN_SOUTH, 1);
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return device_->isGripPressed(); }));
  EXPECT_EQ(device_->report().buttons, kSouthButton);

  DeviceOptions options;
  options.grip = "right";
  open(options);
  EXPECT_FALSE(device_->isGripPressed());
  pad_.tell(EV_KEY, BTN_TR, 1);
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return device_->isGripPressed(); }));
}

TEST_F(GamepadLive, UnpluggedItIsNotReadyAndSaysSo) {
  open({});
  EXPECT_TRUE(device_->report().is_ready);
  pad_.setPluggedIn(false);
  EXPECT_TRUE(readUntil([](const DeviceSample& sample) { return !sample.valid; }));
  EXPECT_TRUE(device_->guard().is_cut);
  EXPECT_EQ(device_->report().state, "unplugged");
  EXPECT_NE(device_->report().trouble, "");
}

TEST(GamepadList, TellsTheForceFeedbackAndTheRemedyInOneLine) {
  GamepadAddress address{"/dev/input/event5", "Pad", Feel::kRumble, true};
  EXPECT_EQ(toText(toPluggedIn(address).spec), "gamepad:/dev/input/event5");
  EXPECT_EQ(toPluggedIn(address).text, "gamepad, Pad, rumble");
  address.feel = Feel::kForce;
  address.may_open = false;
  EXPECT_EQ(toPluggedIn(address).text,
            "gamepad, Pad, force on the stick; no right to open it: join the group input "
            "(sudo usermod -aG input $USER), or install the udev rule of Tandem");
}

}  // namespace
}  // namespace tandem::demos
