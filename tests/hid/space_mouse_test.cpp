#include <gtest/gtest.h>

#include "tandem/falcon/space_mouse_device.h"

#include "falcon/src/hid/space_mouse_emulator.h"
#include "hid/user_hidraw.h"

namespace tandem {
namespace {

using test::bytesOf;
using test::comesTrue;

class SpaceMouseOverHidapi : public testing::TestWithParam<SpaceMouseLayout> {};

TEST_P(SpaceMouseOverHidapi, MovesThePointSurvivesUnpluggingAndRefusesRubbish) {
  test::UserHidraw node("space-mouse", makeSpaceMouseDescriptor(GetParam()));
  SpaceMouseSettings settings;
  settings.stream.first_retry = 0.001;
  SpaceMouseDevice device([&] { return openSpaceMouse(node.path()); }, settings);
  SpaceMouseEmulator emulator(GetParam());
  std::uint64_t sent = 0;
  DeviceSample sample;
  const auto run = [&](int from, int to) {
    for (int tick = from; tick < to; ++tick) {
      while (const auto report = emulator.next(tick * 1e-3))
        if (node.send(bytesOf(*report))) ++sent;
      ASSERT_TRUE(comesTrue([&] { return device.status().counters.reports == sent; }));
      sample = device.read(tick * 1e-3);
      ASSERT_TRUE(sample.valid);
    }
  };

  emulator.move({0, 350, 0, 0, 0, 175});  // towards the user, and a rotation
  run(0, 200);
  EXPECT_NEAR(sample.hip.v_W.z(), 0.15, 1e-3);
  EXPECT_EQ(sample.hip.v_W.x(), 0.0);
  EXPECT_EQ(device.status().state.axes[5], 0.5);
  ASSERT_TRUE(sample.wrist);
  EXPECT_NEAR(sample.wrist->w_W.y(), -1.5 * (0.5 - 0.05) / 0.95, 5e-3);
  ASSERT_TRUE(node.send({0x42, 1, 2, 3}));
  ASSERT_TRUE(node.send({1, 2, 3}));
  sent += 2;
  run(200, 300);
  EXPECT_EQ(device.status().counters.refused, 2U);

  node.unplug();
  ASSERT_TRUE(comesTrue([&] { return !device.read(0.3).valid; }));
  EXPECT_EQ(device.read(0.301).hip.v_W, Vec3(Vec3::Zero()));
  node.plugIn();
  ASSERT_TRUE(comesTrue([&] { return device.read(0.302).valid; }));
  run(303, 600);
  EXPECT_NEAR(sample.hip.v_W.z(), 0.15, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Layouts, SpaceMouseOverHidapi,
                         testing::Values(SpaceMouseLayout::kOld, SpaceMouseLayout::kNew));

TEST(SpaceMouseOpen, SaysThatThereIsNone) {
  if (!findSpaceMice().empty()) GTEST_SKIP() << "a SpaceMouse is plugged in here";
  EXPECT_THROW((void)openSpaceMouse(), Error);
}

}  // namespace
}  // namespace tandem
