#include "falcon/src/gamepad/gamepad_axes.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "devices/fake_event_port.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::FakeEventDevice;
using Sticks = std::array<double, 3>;

constexpr InputEvent kReport{EV_SYN, SYN_REPORT, 0};

InputEvent axis(int code, std::int32_t value) {
  return {EV_ABS, static_cast<std::uint16_t>(code), value};
}

InputEvent key(int code, std::int32_t value) {
  return {EV_KEY, static_cast<std::uint16_t>(code), value};
}

TEST(GamepadAxes, SticksOfAPadMoveTheHand) {
  FakeEventDevice pad;
  FakeEventDevice::makePad(pad);
  GamepadAxes axes(*pad.open());
  EXPECT_TRUE(axes.hasStick());
  for (const double part : axes.state().sticks) EXPECT_NEAR(part, 0.0, 1e-4);

  EXPECT_EQ(axes.take(axis(ABS_X, 32767)), GamepadNews::kPart);
  (void)axes.take(axis(ABS_Y, -32768));  // the kernel's up: away from the user
  (void)axes.take(axis(ABS_RY, -32768));
  EXPECT_EQ(axes.take(kReport), GamepadNews::kReport);
  EXPECT_NEAR(axes.state().sticks[0], 1.0, 1e-12);
  EXPECT_NEAR(axes.state().sticks[1], 1.0, 1e-4);
  EXPECT_NEAR(axes.state().sticks[2], -1.0, 1e-12);
}

TEST(GamepadAxes, TriggersAndTheDirectionalPadRaiseAndLower) {
  FakeEventDevice pad;
  FakeEventDevice::makePad(pad);
  GamepadAxes axes(*pad.open());
  (void)axes.take(axis(ABS_RZ, 255));
  EXPECT_NEAR(axes.state().sticks[1], 1.0, 1e-4);
  (void)axes.take(axis(ABS_Z, 255));
  EXPECT_NEAR(axes.state().sticks[1], 0.0, 1e-4) << "both pulled";
  (void)axes.take(axis(ABS_HAT0Y, -1));
  EXPECT_NEAR(axes.state().sticks[1], 1.0, 1e-4);
  (void)axes.take(axis(ABS_RY, -32768));
  EXPECT_EQ(axes.state().sticks[1], 1.0) << "the sum is clamped";
}

// Pads without a driver of their own have the right stick on Z and RZ, and triggers on RX and RY.
TEST(GamepadAxes, AnAxisThatRestsAtItsEndIsNoStick) {
  FakeEventDevice pad;
  for (const auto code : {ABS_X, ABS_Y, ABS_Z, ABS_RZ}) pad.setAxis(code, {127, 0, 255});
  for (const auto code : {ABS_RX, ABS_RY}) pad.setAxis(code, {0, 0, 255});
  pad.setFeel(Feel::kRumble);
  GamepadAxes axes(*pad.open());
  EXPECT_NEAR(axes.state().sticks[1], 0.0, 0.01);
  (void)axes.take(axis(ABS_RZ, 255));
  EXPECT_EQ(axes.state().sticks[1], -1.0);
}

TEST(GamepadAxes, PedalsOfAWheelMoveNothing) {
  FakeEventDevice wheel;
  wheel.setAxis(ABS_X, {32768, 0, 65535});
  for (const auto code : {ABS_Y, ABS_Z, ABS_RZ}) wheel.setAxis(code, {255, 0, 255});
  wheel.setFeel(Feel::kForce);
  GamepadAxes axes(*wheel.open());
  for (const auto code : {ABS_Y, ABS_Z, ABS_RZ}) (void)axes.take(axis(code, 10));
  (void)axes.take(axis(ABS_X, 65535));
  EXPECT_EQ(axes.state().sticks, (Sticks{1.0, 0.0, 0.0}));
}

TEST(GamepadAxes, ButtonsAreBitsOfTheirBlock) {
  FakeEventDevice pad;
  FakeEventDevice::makePad(pad);
  pad.press(BTN_TR, true);
  GamepadAxes axes(*pad.open());
  EXPECT_EQ(axes.state().buttons, kRightShoulder) << "pressed at the start";
  (void)axes.take(key(BTN_SOUTH, 1));
  (void)axes.take(key(BTN_TR, 0));
  (void)axes.take(key(KEY_A, 1));
  (void)axes.take(key(BTN_TOUCH, 1));
  EXPECT_EQ(axes.state().buttons, kSouthButton);
  (void)axes.take(key(BTN_SOUTH, 0));
  (void)axes.take(key(BTN_TRIGGER, 1));
  EXPECT_EQ(axes.state().buttons, kSouthButton) << "a joystick's trigger";
}

TEST(GamepadAxes, AfterLostEventsTheStateIsReadAnew) {
  FakeEventDevice pad;
  FakeEventDevice::makePad(pad);
  const auto port = pad.open();
  GamepadAxes axes(*port);
  (void)axes.take({EV_SYN, SYN_DROPPED, 0});
  (void)axes.take(axis(ABS_X, 32767));
  (void)axes.take(key(BTN_SOUTH, 1));
  EXPECT_NEAR(axes.state().sticks[0], 0.0, 1e-4) << "events after a loss are stale";
  EXPECT_EQ(axes.take(kReport), GamepadNews::kLost);

  pad.move(ABS_X, -32768);
  pad.press(BTN_EAST, true);
  axes.readAll(*port);
  EXPECT_EQ(axes.state().sticks[0], -1.0);
  EXPECT_EQ(axes.state().buttons, kEastButton);
  EXPECT_EQ(axes.take(kReport), GamepadNews::kReport);
}

TEST(GamepadAxes, ARangeWithoutExtentIsNoAxis) {
  FakeEventDevice device;
  device.setAxis(ABS_X, {5, 5, 5});
  device.setAxis(ABS_Y, {0, 100, -100});
  GamepadAxes axes(*device.open());
  EXPECT_FALSE(axes.hasStick());
  (void)axes.take(axis(ABS_X, 7));
  (void)axes.take(axis(ABS_Y, 7));
  EXPECT_EQ(axes.state().sticks, (Sticks{}));
}

/// A device whose every number is drawn, extremes among them.
class HostileDevice {
 public:
  explicit HostileDevice(std::uint64_t seed) : random_(seed) {}

  std::int32_t draw() {
    switch (random_.below(4)) {
      case 0:
        return std::numeric_limits<std::int32_t>::min();
      case 1:
        return std::numeric_limits<std::int32_t>::max();
      case 2:
        return random_.below(7) - 3;
      default:
        return static_cast<std::int32_t>(random_.uniform(-2147483648.0, 2147483647.0));
    }
  }
  InputEvent drawEvent() {
    const auto type = static_cast<std::uint16_t>(random_.below(5));
    const int code = random_.below(3) == 0 ? random_.below(0x10000) : random_.below(0x20);
    return {type, static_cast<std::uint16_t>(code), draw()};
  }
  void drawAxes(FakeEventDevice& device) {
    for (int code = 0; code <= ABS_HAT0Y; ++code)
      if (random_.below(3) > 0) device.setAxis(code, {draw(), draw(), draw()});
    device.setFeel(static_cast<Feel>(random_.below(3)));
  }

 private:
  test::Random random_;
};

TEST(GamepadAxes, AnyEventsOfAnyDeviceKeepSticksInTheirRange) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    HostileDevice hostile(seed);
    FakeEventDevice device;
    hostile.drawAxes(device);
    const auto port = device.open();
    GamepadAxes axes(*port);
    for (int i = 0; i < 300; ++i) {
      if (axes.take(hostile.drawEvent()) == GamepadNews::kLost) axes.readAll(*port);
      const GamepadState state = axes.state();
      for (const double part : state.sticks) ASSERT_LE(std::abs(part), 1.0);
      ASSERT_LT(state.buttons, 0x10000U);
    }
  }
}

}  // namespace
}  // namespace tandem
