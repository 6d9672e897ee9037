// A device with all layers between it and a site, against an emulated, homed Falcon.

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tandem/falcon/emulated_falcon_port.h"
#include "tandem/falcon/monotonic_clock.h"

#include "demos/program/device/open_device.h"
#include "demos/program/device/user_axes.h"
#include "falcon/src/novint/falcon_emulator.h"

namespace tandem::demos {
namespace {

constexpr double kLongest = 20.0;  // longest wait for any outcome [s]

class LiveDeviceTest : public ::testing::Test {
 protected:
  static FalconEmulatorSettings makeHomed() {
    FalconEmulatorSettings settings;
    settings.runs = settings.is_homed = true;
    return settings;
  }

  void open(DeviceOptions options) {
    options.device = "falcon@" + port_.path();
    device_ =
        openDevice(options, {computeUserAxes(Quat::Identity(), 0), kCentre_W}, UserWish::kRest);
    ASSERT_TRUE(readUntil([](const DeviceSample& sample) { return sample.valid; }));
  }
  void hold(const Vec3& p_D) {
    port_.visit([&](FalconEmulator& emulator, double) {
      emulator.plant().hold(Vec3(Vec3(0.0, 0.0, 0.125) + p_D));
    });
  }
  void press(std::uint8_t buttons) {
    port_.visit([&](FalconEmulator& emulator, double) { emulator.press(buttons); });
  }
  bool readUntil(const std::function<bool(const DeviceSample&)>& is_so) {
    for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
         sleepFor(1e-3))
      if (is_so(sample_ = device_->read(0.0))) return true;
    return false;
  }
  /// Reads until the world's point is there, to an encoder's step.
  bool readUntilAt(const Vec3& p_W) {
    return readUntil([&](const DeviceSample& sample) {
      return sample.valid && (sample.hip.p_W - p_W).norm() < 2e-4;
    });
  }
  /// Waits for as many readings as the driver needs to accept the hand's motion.
  void waitForReadings() {
    const std::uint64_t seen = device_->report().readings;
    ASSERT_TRUE(
        readUntil([&](const DeviceSample&) { return device_->report().readings > seen + 20; }));
  }

  const Vec3 kCentre_W = Vec3(1.0, 2.0, 3.0);
  EmulatedFalconPort port_{makeHomed()};
  std::unique_ptr<LiveDevice> device_;
  DeviceSample sample_;
};

TEST_F(LiveDeviceTest, PlacesAndScalesTheHand) {
  DeviceOptions options;
  options.scale = 2.0;
  options.offset = {0.1, 0.0, 0.0};
  hold(Vec3::Zero());
  open(options);
  EXPECT_FALSE(device_->hasGrip());
  EXPECT_TRUE(readUntilAt(kCentre_W + Vec3(0.1, 0, 0)));
  EXPECT_LT(device_->distanceFromMiddle(), 1e-4);
  hold(Vec3(0.0, 0.01, -0.02));  // up, and away from the user
  EXPECT_TRUE(readUntilAt(kCentre_W + Vec3(0.1 + 0.04, 0.0, 0.02)));
  EXPECT_NEAR(device_->distanceFromMiddle(), std::hypot(0.01, 0.02), 2e-4);
}

TEST_F(LiveDeviceTest, AButtonIsItsClutch) {
  DeviceOptions options;
  options.clutch = "centre";
  hold(Vec3::Zero());
  open(options);
  EXPECT_TRUE(readUntilAt(kCentre_W));
  press(kPlusButton);  // another button
  hold(Vec3(0.0, 0.0, -0.01));
  EXPECT_TRUE(readUntilAt(kCentre_W + Vec3(0.01, 0, 0)));

  press(kCentreButton);
  ASSERT_TRUE(readUntil([&](const DeviceSample&) { return !device_->isEngaged(); }));
  const Vec3 stays_W = device_->read(0.0).hip.p_W;
  hold(Vec3(0.0, 0.0, 0.02));
  waitForReadings();
  press(0);
  ASSERT_TRUE(readUntil([&](const DeviceSample&) { return device_->isEngaged(); }));
  EXPECT_LT((sample_.hip.p_W - stays_W).norm(), 2e-4);
  hold(Vec3(0.0, 0.0, 0.01));
  EXPECT_TRUE(readUntilAt(stays_W + Vec3(0.01, 0, 0)));
}

TEST_F(LiveDeviceTest, AnotherButtonHoldsThings) {
  DeviceOptions options;
  options.clutch = "centre";
  options.grip = "forward";
  hold(Vec3::Zero());
  open(options);
  EXPECT_TRUE(readUntilAt(kCentre_W));
  EXPECT_FALSE(device_->isGripPressed());
  press(kForwardButton);
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return device_->isGripPressed(); }));
  EXPECT_TRUE(device_->isEngaged());
  press(0);
  EXPECT_TRUE(readUntil([&](const DeviceSample&) { return !device_->isGripPressed(); }));
}

TEST_F(LiveDeviceTest, IsHeldUntilItIsTicked) {
  hold(Vec3(0.01, 0.01, 0.01));
  open({});
  device_->holdUntilTicked(kCentre_W);
  EXPECT_TRUE(readUntilAt(kCentre_W));
  hold(Vec3(-0.02, 0.0, 0.0));
  waitForReadings();
  EXPECT_EQ(sample_.hip.p_W, kCentre_W);
  device_->write(Vec3::Zero());
  ASSERT_TRUE(readUntil([&](const DeviceSample& s) { return s.valid && device_->isEngaged(); }));
  EXPECT_LT((sample_.hip.p_W - kCentre_W).norm(), 2e-4);
  hold(Vec3(-0.02, 0.01, 0.0));
  EXPECT_TRUE(readUntilAt(kCentre_W + Vec3(0, 0, 0.01)));
}

}  // namespace
}  // namespace tandem::demos
