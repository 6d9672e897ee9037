#include "tandem/falcon/hid_switch.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "devices/fake_hid_port.h"
#include "falcon/src/hid/hid_stream.h"

namespace tandem {
namespace {

using test::Bytes;
using test::comesTrue;
using test::FakeHidDevice;

constexpr HidSwitchMap kButton{HidSwitchKind::kBits, 3, 1, 0x06};
constexpr HidSwitchMap kKeyB{HidSwitchKind::kKey, 0, 2, 0x05};
constexpr HidSwitchMap kPlay{HidSwitchKind::kUsage, 2, 1, 0x01CD};

std::optional<bool> read(const HidSwitchMap& map, const Bytes& report) {
  return readSwitch(map, report.data(), report.size());
}

TEST(HidSwitchMap, BitsAreThoseOfTheMask) {
  EXPECT_EQ(read(kButton, {3, 0x02}), true);
  EXPECT_EQ(read(kButton, {3, 0x0C}), true);
  EXPECT_EQ(read(kButton, {3, 0xF9}), false);
  EXPECT_EQ(read(kButton, {1, 0x02}), std::nullopt) << "another report";
  EXPECT_EQ(read(kButton, {3}), std::nullopt) << "too short";
  EXPECT_EQ(read(kButton, {}), std::nullopt);
  EXPECT_EQ(read(HidSwitchMap{}, {0x01}), true) << "without identifiers";
}

TEST(HidSwitchMap, AKeyMayBeAnywhereAmongThosePressed) {
  EXPECT_EQ(read(kKeyB, {0, 0, 0x05, 0, 0, 0, 0, 0}), true);
  EXPECT_EQ(read(kKeyB, {0, 0, 0x04, 0x06, 0x05, 0, 0, 0}), true);
  EXPECT_EQ(read(kKeyB, {0x05, 0x05, 0x04, 0, 0, 0, 0, 0}), false) << "shift keys are no keys";
  EXPECT_EQ(read(kKeyB, {0, 0}), std::nullopt);
}

TEST(HidSwitchMap, AUsageIsOneOfSixteenBits) {
  EXPECT_EQ(read(kPlay, {2, 0xCD, 0x01}), true);
  EXPECT_EQ(read(kPlay, {2, 0xCD, 0x00}), false);
  EXPECT_EQ(read(kPlay, {2, 0xCD}), std::nullopt);
}

HidStreamSettings makeQuick() {
  HidStreamSettings settings;
  settings.first_retry = 0.001;
  return settings;
}

TEST(HidSwitch, IsPressedWhileTheDeviceSaysSo) {
  FakeHidDevice fake;
  HidSwitch pedal(fake.opener(), kButton, makeQuick());
  EXPECT_FALSE(pedal.isPressed()) << "nothing has come";
  fake.send({3, 0x02});
  EXPECT_TRUE(comesTrue([&] { return pedal.isPressed(); }));
  fake.send({7, 0x00});
  ASSERT_TRUE(comesTrue([&] { return pedal.stream().counters().reports == 2; }));
  EXPECT_TRUE(pedal.isPressed()) << "another report says nothing of it";
  fake.send({3, 0x00});
  EXPECT_TRUE(comesTrue([&] { return !pedal.isPressed(); }));
  EXPECT_EQ(pedal.stream().counters().refused, 0U);
}

TEST(HidSwitch, UnpluggedIsReleasedAndStaysSoUntilPressedAgain) {
  FakeHidDevice fake;
  HidSwitch pedal(fake.opener(), kButton, makeQuick());
  fake.send({3, 0x02});
  ASSERT_TRUE(comesTrue([&] { return pedal.isPressed(); }));
  fake.setPluggedIn(false);
  EXPECT_TRUE(comesTrue([&] { return !pedal.isPressed(); }));
  ASSERT_TRUE(comesTrue([&] { return !pedal.stream().trouble().empty(); }));
  fake.setPluggedIn(true);
  ASSERT_TRUE(comesTrue([&] { return pedal.stream().isConnected(); }));
  EXPECT_FALSE(pedal.isPressed());
}

TEST(HidSwitch, ABrokenReportReleases) {
  FakeHidDevice fake;
  HidSwitch pedal(fake.opener(), kButton, makeQuick());
  fake.send({3, 0x02});
  ASSERT_TRUE(comesTrue([&] { return pedal.isPressed(); }));
  fake.send({3});
  EXPECT_TRUE(comesTrue([&] { return pedal.stream().counters().refused == 1; }));
  EXPECT_FALSE(pedal.isPressed());
}

TEST(HidSwitch, RefusesMapsThatNoReportFulfils) {
  FakeHidDevice fake;
  const auto expectRefused = [&](const HidSwitchMap& map) {
    EXPECT_THROW((void)HidSwitch(fake.opener(), map), std::invalid_argument);
  };
  expectRefused({HidSwitchKind::kBits, 256, 0, 1});
  expectRefused({HidSwitchKind::kBits, -1, 0, 1});
  expectRefused({HidSwitchKind::kBits, 0, 65, 1});
  expectRefused({HidSwitchKind::kUsage, 0, 64, 1});
  expectRefused({HidSwitchKind::kBits, 0, 0, 0});
  expectRefused({HidSwitchKind::kKey, 0, 0, 256});
}

}  // namespace
}  // namespace tandem
