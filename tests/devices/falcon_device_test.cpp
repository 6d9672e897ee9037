// The whole device in real time: its thread, a real pseudo terminal, and the emulator behind it.
// Waits are for outcomes; their deadlines measure nothing.

#include "tandem/falcon/falcon_device.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "tandem/coordination/types.h"
#include "tandem/falcon/byte_transport.h"
#include "tandem/falcon/emulated_falcon_port.h"
#include "tandem/falcon/monotonic_clock.h"

#include "devices/patient_falcon.h"
#include "falcon/src/novint/falcon_emulator.h"

namespace tandem {
namespace {

using namespace test;

/// Ticks a device as a site does, a thousand times a second.
class FalconOverTty : public ::testing::Test {
 protected:
  void start(const FalconEmulatorSettings& settings = readyDevice()) {
    port_ = std::make_unique<EmulatedFalconPort>(settings, makeHoldingHand());
    device_ = std::make_unique<FalconDevice>(patientSettings(), makeSyntheticFirmware(3),
                                             [path = port_->path()] { return openTty(path); });
  }

  /// Ticks until `is_so`; false after kLongest.
  bool tickUntil(const std::function<bool(const FalconStatus&)>& is_so) {
    for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
         sleepFor(0.001)) {
      sample_ = device_->read(readMonotonicClock());
      device_->write(push_);  // without a valid sample the device must let go by itself
      if (is_so(device_->status())) return true;
    }
    return false;
  }
  bool tickUntil(FalconState state) {
    return tickUntil([state](const FalconStatus& status) { return status.state == state; });
  }
  bool tickUntilFault(FalconFault fault) {
    return tickUntil([fault](const FalconStatus& status) { return status.fault == fault; });
  }
  /// Ticks until the emulated grip is pushed with the commanded force, by a reading that is valid.
  bool tickUntilPushed() {
    // A busy machine makes a reading too old for a tick now and then.
    return tickUntil(
        [this](const FalconStatus&) { return sample_.valid && (force() - push_).norm() < 0.05; });
  }
  bool tickUntilForceIsGone() {
    return tickUntil([this](const FalconStatus&) { return force().norm() == 0.0; });
  }

  Vec3 force() {
    Vec3 force_D = Vec3::Zero();
    visit([&](FalconEmulator& emulator) { force_D = emulator.plant().force(); });
    return force_D;
  }
  void visit(const std::function<void(FalconEmulator&)>& visitor) {
    port_->visit([&](FalconEmulator& emulator, double) { visitor(emulator); });
  }
  void home() {
    for (const double z : {0.165, 0.125}) {
      visit([z](FalconEmulator& emulator) { emulator.plant().hold(Vec3(0.0, 0.0, z)); });
      ASSERT_TRUE(tickUntil([z](const FalconStatus& s) { return z < 0.15 || s.homed == 7; }));
    }
    visit([](FalconEmulator& emulator) { emulator.plant().hold(std::nullopt); });
  }
  void expectLimits() {
    visit([](FalconEmulator& emulator) {
      // The margins cover a grip that moves while a command is on its way, on a busy machine.
      EXPECT_LT(emulator.felt().most_force, 8.0 * 1.06);
      EXPECT_LT(emulator.felt().most_change, 2.0 * 1.1);
      EXPECT_EQ(emulator.strange(), 0U);
    });
  }
  void expectWork() {
    ASSERT_TRUE(tickUntil(FalconState::kReady));
    EXPECT_EQ(device_->status().fault, FalconFault::kNone);
    ASSERT_TRUE(tickUntilPushed());
    EXPECT_LT(sample_.hip.p_W.norm(), 0.01);
    expectLimits();
  }
  /// Damages replies by `mishap` until the fault is reported; then the device recovers.
  void expectFaultAndRecovery(int FalconMishaps::*mishap, FalconFault fault) {
    visit([mishap](FalconEmulator& emulator) {
      emulator.mishaps.*mishap = FalconMishaps::kAlways;
      emulator.mishaps.split_time = 0.7;
    });
    ASSERT_TRUE(tickUntilFault(fault));
    EXPECT_TRUE(tickUntilForceIsGone());
    EXPECT_TRUE(tickUntil([this](const FalconStatus&) { return !sample_.valid; }));
    visit([mishap](FalconEmulator& emulator) { emulator.mishaps.*mishap = 0; });
    expectWork();
  }

  Vec3 push_ = Vec3(2.0, -4.0, 3.0);
  std::unique_ptr<EmulatedFalconPort> port_;
  std::unique_ptr<FalconDevice> device_;
  DeviceSample sample_;
};

TEST_F(FalconOverTty, BootsAfterCorruptedEchoesAndIsHomed) {
  FalconEmulatorSettings settings;
  settings.answers_with_zero = settings.echoes_with_dc3 = true;
  port_ = std::make_unique<EmulatedFalconPort>(settings, makeHoldingHand());
  visit([](FalconEmulator& emulator) {
    emulator.mishaps.wrong_loads = 2;
    emulator.mishaps.load_byte = 321;
    emulator.mishaps.silent_calls = 3;
  });
  device_ = std::make_unique<FalconDevice>(patientSettings(), makeSyntheticFirmware(3),
                                           [path = port_->path()] { return openTty(path); });
  EXPECT_TRUE(tickUntilFault(FalconFault::kWrongBootEcho));
  ASSERT_TRUE(tickUntil(FalconState::kUnhomed));
  EXPECT_FALSE(sample_.valid);
  EXPECT_EQ(force().norm(), 0.0);
  home();
  expectWork();
}

TEST_F(FalconOverTty, BootThatNeverSucceedsIsAStatedFault) {
  FalconEmulatorSettings settings;
  port_ = std::make_unique<EmulatedFalconPort>(settings);
  visit([](FalconEmulator& emulator) { emulator.mishaps.wrong_loads = 2; });
  FalconSettings two_tries = patientSettings();
  two_tries.boot.tries = 2;
  device_ = std::make_unique<FalconDevice>(two_tries, makeSyntheticFirmware(3),
                                           [path = port_->path()] { return openTty(path); });
  EXPECT_TRUE(tickUntil(FalconState::kFault));
  EXPECT_EQ(device_->status().fault, FalconFault::kWrongBootEcho);
  EXPECT_FALSE(sample_.valid);
  EXPECT_TRUE(tickUntil(FalconState::kUnhomed));  // the third one is right
}

TEST_F(FalconOverTty, PushesNoHarderThanItMay) {
  start();
  push_ = Vec3(10.0, -25.0, 15.0);
  ASSERT_TRUE(tickUntil([this](const FalconStatus&) { return force().norm() > 8.0 * 0.99; }));
  EXPECT_LT(force().stableNormalized().cross(push_.normalized()).norm(), 0.02);
  expectLimits();
}

TEST_F(FalconOverTty, ShortReplies) {
  start();
  expectWork();
  expectFaultAndRecovery(&FalconMishaps::short_replies, FalconFault::kDamagedReplies);
}

TEST_F(FalconOverTty, LostBytes) {
  start();
  expectWork();
  expectFaultAndRecovery(&FalconMishaps::lost_bytes, FalconFault::kDamagedReplies);
}

TEST_F(FalconOverTty, NoReplies) {
  start();
  expectWork();
  expectFaultAndRecovery(&FalconMishaps::silent_replies, FalconFault::kNoReply);
}

// A doubled byte spoils only its own reply, a split reply spoils nothing. Neither stops the device.
TEST_F(FalconOverTty, DoubledBytesAndSplitRepliesAreBorne) {
  start();
  expectWork();
  visit([](FalconEmulator& emulator) {
    emulator.mishaps.doubled_bytes = emulator.mishaps.split_replies = 50;
    emulator.mishaps.split_time = 0.001;
  });
  ASSERT_TRUE(tickUntil([this](const FalconStatus&) {
    int left = 0;
    visit([&](FalconEmulator& emulator) { left = emulator.mishaps.split_replies; });
    return left == 0;
  }));
  expectWork();
  EXPECT_GT(device_->status().resyncs, 0U);
}

TEST_F(FalconOverTty, PiecesThatComeTooLate) {
  start();
  expectWork();
  visit([](FalconEmulator& emulator) {
    emulator.mishaps.split_replies = FalconMishaps::kAlways;
    emulator.mishaps.split_time = 0.8;
  });
  ASSERT_TRUE(tickUntil(FalconState::kFault));
  EXPECT_TRUE(tickUntilForceIsGone());
  visit([](FalconEmulator& emulator) { emulator.mishaps.split_replies = 0; });
  expectWork();
}

TEST_F(FalconOverTty, Unplugged) {
  start();
  expectWork();
  for (int i = 0; i < 3; ++i) {
    port_->unplug();
    ASSERT_TRUE(tickUntilFault(FalconFault::kUnplugged));
    EXPECT_TRUE(tickUntil(FalconState::kClosed));
    EXPECT_TRUE(tickUntil([this](const FalconStatus&) { return !sample_.valid; }));
    EXPECT_TRUE(tickUntil([](const FalconStatus& s) { return s.open_error[0] != '\0'; }));
    // The emulator keeps its last force, as a device may. The first frame removes it.
    port_->plugIn();
    ASSERT_TRUE(tickUntil(FalconState::kReady));
    ASSERT_TRUE(tickUntilPushed());
  }
  EXPECT_EQ(device_->status().opened, 4U);
}

TEST_F(FalconOverTty, PowerCycledWhileRunning) {
  start();
  expectWork();
  port_->visit([](FalconEmulator& emulator, double now) { emulator.switchOff(now); });
  ASSERT_TRUE(tickUntil(FalconState::kFault));
  EXPECT_EQ(force().norm(), 0.0);
  ASSERT_TRUE(tickUntilFault(FalconFault::kFirmwareLost));
  port_->visit([](FalconEmulator& emulator, double now) { emulator.switchOn(now); });
  ASSERT_TRUE(tickUntil(FalconState::kUnhomed));
  EXPECT_FALSE(sample_.valid);
  EXPECT_EQ(force().norm(), 0.0);
  home();
  expectWork();
  EXPECT_EQ(device_->status().boots, 2U);
}

TEST_F(FalconOverTty, ClosingTakesTheForceAwayAndPutsTheLightsOut) {
  start();
  expectWork();
  device_.reset();
  visit([](FalconEmulator& emulator) {
    EXPECT_EQ(emulator.command().motors, FalconMotors{});
    EXPECT_EQ(emulator.command().lights, 0);
    EXPECT_LT(emulator.felt().most_change, 2.0 * 1.02);
  });
  // The line is free again, and the device is still homed.
  device_ = std::make_unique<FalconDevice>(patientSettings(), FirmwareImage{},
                                           [path = port_->path()] { return openTty(path); });
  expectWork();
}

TEST(FalconDevice, OneThatCannotBeOpenedSaysWhy) {
  FalconDevice device({}, {}, [] { return openTty("/dev/no-such-falcon"); });
  for (const double end = readMonotonicClock() + kLongest; readMonotonicClock() < end;
       sleepFor(0.005))
    if (device.status().fault == FalconFault::kCannotOpen) break;
  EXPECT_EQ(device.status().state, FalconState::kClosed);
  EXPECT_EQ(std::string(device.status().open_error.data()).rfind("/dev/no-such-falcon: No such", 0),
            0U);
  EXPECT_FALSE(device.read(0.0).valid);
  EXPECT_EQ(device.capabilities().max_force, 8.0);
  EXPECT_EQ(device.capabilities().max_slew, 2000.0);
}

TEST_F(FalconOverTty, TellsItsButtonsToAnyThread) {
  start();
  ASSERT_TRUE(tickUntil(FalconState::kReady));
  EXPECT_EQ(device_->buttons(), 0);
  visit([](FalconEmulator& emulator) { emulator.press(kCentreButton | kPlusButton); });
  EXPECT_TRUE(tickUntil(
      [this](const FalconStatus&) { return device_->buttons() == (kCentreButton | kPlusButton); }));
  EXPECT_TRUE(tickUntil([this](const FalconStatus&) {
    return sample_.valid && sample_.buttons == (kCentreButton | kPlusButton);
  }));
  // A silent device reports no pressed button, so that a clutch cannot stay out for ever.
  visit([](FalconEmulator& emulator) { emulator.mishaps.silent_replies = FalconMishaps::kAlways; });
  EXPECT_TRUE(tickUntil([this](const FalconStatus&) { return device_->buttons() == 0; }));
}

// Reading a sample again does not make it newer: it expires by the reader's time.
TEST(FalconDevice, AReadingThatStaysIsNotValidForLong) {
  FalconEmulator emulator(readyDevice());
  FalconDevice device(patientSettings(), {}, [&emulator] { return openEmulator(emulator); });
  DeviceSample sample;
  double now = 0.0;
  for (const double end = readMonotonicClock() + kLongest;
       readMonotonicClock() < end && !sample.valid; sleepFor(0.001))
    sample = device.read(now);
  ASSERT_TRUE(sample.valid);
  EXPECT_FALSE(device.read(std::nan("")).valid);
  // The caller's time runs a thousand times faster than the device's.
  int valid = 0;
  for (int i = 0; i < 1000; ++i) valid += device.read(now += 1.0).valid ? 1 : 0;
  EXPECT_LT(valid, 1000);
}

}  // namespace
}  // namespace tandem
