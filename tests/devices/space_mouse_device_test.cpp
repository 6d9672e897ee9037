#include "tandem/falcon/space_mouse_device.h"

#include <gtest/gtest.h>

#include "devices/fake_hid_port.h"
#include "falcon/src/hid/space_mouse_emulator.h"

namespace tandem {
namespace {

using test::bytesOf;
using test::comesTrue;
using test::FakeHidDevice;

class SpaceMouseDeviceTest : public testing::TestWithParam<SpaceMouseLayout> {
 protected:
  SpaceMouseSettings settings() const {
    SpaceMouseSettings settings;
    settings.motion.start_W = Vec3(0.1, 0.2, 0.3);
    settings.stream.first_retry = 0.001;
    return settings;
  }

  /// Sends the emulator's reports due at `now`, and waits until they arrived.
  void tell(SpaceMouseDevice& device, double now) {
    while (const auto report = emulator_.next(now)) {
      fake_.send(bytesOf(*report));
      ++sent_;
    }
    ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == sent_; }));
  }

  SpaceMouseEmulator emulator_{GetParam()};
  FakeHidDevice fake_;
  std::uint64_t sent_ = 0;
};

TEST_P(SpaceMouseDeviceTest, ACapHeldAsideIsAVelocityUntilItIsLetGo) {
  SpaceMouseDevice device(fake_.opener(), settings());
  EXPECT_EQ(device.read(0.0).hip.p_W, Vec3(0.1, 0.2, 0.3));
  emulator_.move({350, 0, -350, 0, 0, 0});  // to the right and up
  DeviceSample sample;
  int tick = 0;
  for (; tick < 400; ++tick) {
    tell(device, tick * 1e-3);
    sample = device.read(tick * 1e-3);
    ASSERT_TRUE(sample.valid);
  }
  EXPECT_NEAR(sample.hip.v_W.x(), 0.15, 1e-4);
  EXPECT_NEAR(sample.hip.v_W.y(), 0.15, 1e-4);
  EXPECT_EQ(sample.hip.v_W.z(), 0.0);
  // 0.399 s minus the time constant that smoothing costs, from the place at the first report.
  EXPECT_NEAR(sample.hip.p_W.x(), 0.1 + 0.15 * (0.399 - 0.03), 2e-4);

  emulator_.move({});
  for (; tick < 800; ++tick) {
    tell(device, tick * 1e-3);
    sample = device.read(tick * 1e-3);
  }
  EXPECT_NEAR(sample.hip.v_W.norm(), 0.0, 1e-5);
  EXPECT_EQ(device.status().counters.refused, 0U);
}

TEST_P(SpaceMouseDeviceTest, TurnsAndButtonsAreInTheStatus) {
  SpaceMouseDevice device(fake_.opener(), settings());
  emulator_.move({0, 0, 0, 35, -70, 350});
  emulator_.press(2);
  tell(device, 0.0);
  tell(device, 0.008);
  const SpaceMouseStatus status = device.status();
  EXPECT_EQ(status.state.axes, (std::array{0.0, 0.0, 0.0, 0.1, -0.2, 1.0}));
  EXPECT_EQ(status.state.buttons, 2U);
  EXPECT_EQ(status.name, "HID fake");
  EXPECT_TRUE(status.is_connected);
}

TEST_P(SpaceMouseDeviceTest, SilenceOfASecondEndsTheMotion) {
  SpaceMouseDevice device(fake_.opener(), settings());
  emulator_.move({35, 0, 0, 0, 0, 0});
  tell(device, 0.0);
  DeviceSample sample;
  int tick = 0;
  for (; tick < 1000; ++tick) sample = device.read(tick * 1e-3);
  EXPECT_GT(sample.hip.v_W.x(), 0.007);
  for (; tick < 2000; ++tick) sample = device.read(tick * 1e-3);
  EXPECT_NEAR(sample.hip.v_W.x(), 0.0, 1e-12);
}

// The user has not seen the point move in the meantime.
TEST_P(SpaceMouseDeviceTest, AfterASiteHasStoodThePointGoesOnFromWhereItWas) {
  SpaceMouseDevice device(fake_.opener(), settings());
  emulator_.move({350, 0, 0, 0, 0, 0});
  DeviceSample sample;
  for (int tick = 0; tick < 300; ++tick) {
    tell(device, tick * 1e-3);
    sample = device.read(tick * 1e-3);
  }
  tell(device, 1.3);
  EXPECT_LE(device.read(1.3).hip.p_W.x() - sample.hip.p_W.x(), 0.15 * 0.020 + 1e-12);
}

TEST_P(SpaceMouseDeviceTest, UnpluggedItStandsAndIsNotValidUntilItIsBack) {
  SpaceMouseDevice device(fake_.opener(), settings());
  emulator_.move({350, 0, 0, 0, 0, 0});
  tell(device, 0.0);
  (void)device.read(0.0);
  ASSERT_GT(device.read(0.1).hip.v_W.x(), 0.0);

  fake_.setPluggedIn(false);
  ASSERT_TRUE(comesTrue([&] { return device.status().trouble == "the fake is not plugged in"; }));
  const DeviceSample gone = device.read(0.2);
  EXPECT_FALSE(gone.valid);
  EXPECT_EQ(gone.hip.v_W, Vec3(Vec3::Zero()));
  EXPECT_EQ(device.read(0.3).hip.p_W, gone.hip.p_W);

  fake_.setPluggedIn(true);
  ASSERT_TRUE(comesTrue([&] { return device.status().is_connected; }));
  const DeviceSample back = device.read(0.4);
  EXPECT_TRUE(back.valid);
  EXPECT_EQ(back.hip.p_W, gone.hip.p_W) << "the cap's old displacement is forgotten";
  EXPECT_EQ(device.status().counters.losses, 1U);
  EXPECT_EQ(device.status().trouble, "");
}

TEST_P(SpaceMouseDeviceTest, RendersNoForceAndCountsWhatItRefuses) {
  SpaceMouseDevice device(fake_.opener(), settings());
  EXPECT_EQ(device.capabilities().max_force, 0.0);
  EXPECT_EQ(device.capabilities().degrees_of_freedom, 0);
  device.write(Vec3(1, 2, 3));
  fake_.send({9, 9, 9});
  fake_.send({1, 9});
  ASSERT_TRUE(comesTrue([&] { return device.status().counters.refused == 2; }));
  EXPECT_TRUE(fake_.outputs().empty());
}

INSTANTIATE_TEST_SUITE_P(Layouts, SpaceMouseDeviceTest,
                         testing::Values(SpaceMouseLayout::kOld, SpaceMouseLayout::kNew));

TEST(SpaceMouseDevice, RefusesWhatItIsNotOpenedWith) {
  FakeHidDevice fake;
  SpaceMouseSettings settings;
  settings.silence = 0.0;
  EXPECT_THROW((void)SpaceMouseDevice(fake.opener(), settings), std::invalid_argument);
  fake.setPluggedIn(false);
  EXPECT_THROW((void)SpaceMouseDevice(fake.opener()), Error);
}

TEST(SpaceMouseEmulator, EndsAMotionByThreeTimesZeroAndIsSilentThen) {
  for (const auto layout : {SpaceMouseLayout::kOld, SpaceMouseLayout::kNew}) {
    SpaceMouseEmulator emulator(layout);
    EXPECT_FALSE(emulator.next(0.0));
    emulator.move({1, 0, 0, 0, 0, 2});
    std::vector<test::Bytes> heard;
    for (int tick = 0; tick < 1000; ++tick) {
      if (tick == 500) emulator.move({});
      while (const auto report = emulator.next(tick * 1e-3)) heard.push_back(bytesOf(*report));
    }
    const bool is_old = layout == SpaceMouseLayout::kOld;
    ASSERT_EQ(heard.size(), 63U + (is_old ? 6U : 3U)) << "one in 8 ms: 0, 8, ... 496";
    for (std::size_t i = 63; i < heard.size(); ++i)
      EXPECT_EQ(std::count(heard[i].begin() + 1, heard[i].end(), 0), is_old ? 6 : 12);
    EXPECT_EQ(heard[0][0], 1);
    EXPECT_EQ(heard[1][0], is_old ? 2 : 1);
  }
}

}  // namespace
}  // namespace tandem
