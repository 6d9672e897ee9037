// The port that speaks to evdev, over a node that this program plays.

#include <cerrno>
#include <numeric>

#include <gtest/gtest.h>

#include "tandem/falcon/event_port.h"
#include "tandem/falcon/gamepad_device.h"

#include "devices/fake_hid_port.h"
#include "hid/user_evdev.h"

namespace tandem {
namespace {

using test::UserEvdev;

class EvdevTest : public testing::Test {
 protected:
  EvdevTest() {
    node_.axes[ABS_X] = {100, -32768, 32767, 16, 128, 0};
    node_.effects = {FF_RUMBLE, FF_GAIN};
  }

  [[nodiscard]] std::string refusal() const {
    try {
      (void)openGamepad(node_.path());
    } catch (const Error& error) {
      return error.what();
    }
    return "opened";
  }

  UserEvdev node_{"pad"};
  std::array<InputEvent, 4> events_{};
};

TEST_F(EvdevTest, ReadsAxesKeysNameAndEffects) {
  node_.press(BTN_EAST);
  const auto port = openGamepad(node_.path());
  EXPECT_EQ(port->name(), node_.path() + " (" + node_.path() + ")") << "its name, and its path";
  EXPECT_EQ(port->feel(), Feel::kRumble);
  const auto axis = port->readAxis(ABS_X);
  ASSERT_TRUE(axis);
  EXPECT_EQ(axis->value, 100);
  EXPECT_EQ(axis->low, -32768);
  EXPECT_EQ(axis->high, 32767);
  EXPECT_FALSE(port->readAxis(ABS_Y));
  EXPECT_FALSE(port->readAxis(0xFFFF));
  EXPECT_TRUE(port->readKey(BTN_EAST));
  EXPECT_FALSE(port->readKey(BTN_SOUTH));
  EXPECT_FALSE(port->readKey(0xFFFF));
}

TEST_F(EvdevTest, GivesWholeEventsAndNoMoreThanThereIsRoomFor) {
  const auto port = openGamepad(node_.path());
  EXPECT_EQ(port->read(events_.data(), events_.size(), 0.0), 0);
  node_.send(EV_ABS, ABS_X, -7);
  ASSERT_EQ(port->read(events_.data(), events_.size(), 1.0), 1);
  EXPECT_EQ(events_[0].type, EV_ABS);
  EXPECT_EQ(events_[0].code, ABS_X);
  EXPECT_EQ(events_[0].value, -7);
  const std::array<input_event, 6> many{};
  node_.send(many.data(), sizeof many);
  EXPECT_EQ(port->read(events_.data(), events_.size(), 1.0), 4);
}

TEST_F(EvdevTest, APartOfAnEventAndAnEndAreALoss) {
  const auto port = openGamepad(node_.path());
  node_.send("part", 4);
  EXPECT_LT(port->read(events_.data(), events_.size(), 1.0), 0);
  node_.unplug();
  EXPECT_LT(port->read(events_.data(), events_.size(), 1.0), 0);
  EXPECT_FALSE(port->play(0, true));
}

TEST_F(EvdevTest, RumbleIsUploadedUpdatedPlayedAndErased) {
  const auto port = openGamepad(node_.path());
  const auto gain = node_.receive(1.0);
  ASSERT_TRUE(gain);
  EXPECT_EQ(gain->code, FF_GAIN);
  EXPECT_EQ(gain->value, 0xFFFF);

  const int id = port->upload(-1, {Feel::kRumble, 0xFFFF, 0});
  ASSERT_EQ(id, 0);
  EXPECT_EQ(port->upload(id, {Feel::kRumble, 0x1234, 0}), id);
  const auto effects = node_.uploaded();
  ASSERT_EQ(effects.size(), 1U);
  EXPECT_EQ(effects.at(0).type, FF_RUMBLE);
  EXPECT_EQ(effects.at(0).u.rumble.strong_magnitude, 0x1234);
  EXPECT_EQ(effects.at(0).u.rumble.weak_magnitude, 0x1234);
  EXPECT_EQ(effects.at(0).replay.length, 1000) << "[ms]; it ends if the program hangs";

  EXPECT_TRUE(port->play(id, true));
  const auto played = node_.receive(1.0);
  ASSERT_TRUE(played);
  EXPECT_EQ(played->type, EV_FF);
  EXPECT_EQ(played->code, id);
  EXPECT_EQ(played->value, 1);
  port->erase(id);
  EXPECT_TRUE(node_.uploaded().empty());
  EXPECT_LT(port->upload(7, {Feel::kRumble, 1, 0}), 0) << "an effect that was never uploaded";
}

TEST_F(EvdevTest, AForceHasALevelOfPositiveSignAndADirection) {
  node_.effects = {FF_CONSTANT};
  const auto port = openGamepad(node_.path());
  EXPECT_EQ(port->feel(), Feel::kForce);
  ASSERT_EQ(port->upload(-1, {Feel::kForce, 0xFFFF, 0xC000}), 0);
  const ff_effect effect = node_.uploaded().at(0);
  EXPECT_EQ(effect.type, FF_CONSTANT);
  EXPECT_EQ(effect.direction, 0xC000);
  EXPECT_EQ(effect.u.constant.level, 0x7FFF);
}

TEST_F(EvdevTest, RefusalsSayWhatToDo) {
  node_.refuseToOpen(EACCES);
  EXPECT_EQ(refusal(), node_.path() +
                           " may not be opened; join the group input (sudo usermod -aG input "
                           "$USER), or install the udev rule of Tandem");
  node_.refuseToOpen(ENODEV);
  EXPECT_EQ(refusal(), node_.path() + " cannot be opened (No such device); see tandem device list");
}

TEST_F(EvdevTest, AGamepadIsFeltEndToEnd) {
  GamepadDevice device([this] { return openGamepad(node_.path()); });
  (void)node_.receive(1.0);  // the gain
  ASSERT_TRUE(test::comesTrue([&] {
    device.write(Vec3(0, 0, 8));
    return node_.uploaded().size() == 1 &&
           node_.uploaded().at(0).u.rumble.strong_magnitude == 0xFFFF;
  }));
  const auto played = node_.receive(5.0);
  ASSERT_TRUE(played);
  EXPECT_EQ(played->value, 1);
  node_.send(EV_ABS, ABS_X, 32767);
  node_.send(EV_SYN, SYN_REPORT, 0);
  ASSERT_TRUE(test::comesTrue([&] { return device.status().state.sticks[0] == 1.0; }));
  node_.unplug();
  ASSERT_TRUE(test::comesTrue([&] { return !device.read(0.0).valid; }));
  EXPECT_NE(device.status().trouble, "");
}

}  // namespace
}  // namespace tandem
