#include <future>

#include <gtest/gtest.h>

#include "tandem/falcon/hid_switch.h"
#include "tandem/falcon/raw_hid_device.h"

#include "devices/ft260_emulator.h"
#include "devices/raw_hid_emulator.h"
#include "falcon/src/hid/hid_uart.h"
#include "hid/user_hidraw.h"

// Runs the questions of tests/devices, which use a port in memory, through the real hidapi.

namespace tandem {
namespace {

using test::Bytes;
using test::comesTrue;
using test::UserHidraw;

/// Plays an FT260 while the test runs: its features, and an answer to each frame.
class Bridge {
 public:
  explicit Bridge(UserHidraw& node) : node_(node) {
    node_.setFeatures([this](const Bytes& feature) { chip_.take(feature); }, nullptr);
  }
  /// Answers up to `count` output reports. Returns how many it answered.
  int answer(int count) {
    for (int i = 0; i < count; ++i) {
      const auto output = node_.receive(10.0);
      if (!output) return i;
      for (const Bytes& input : chip_.answer(*output, i % 16 == 15))
        if (!node_.send(input)) return i;
    }
    return count;
  }
  [[nodiscard]] int baud() const { return chip_.baud(); }

 private:
  UserHidraw& node_;
  test::Ft260Emulator chip_;
};

TEST(HidUartOverHidapi, CarriesTwentyThousandFalconFramesEachWay) {
  constexpr int kCount = 20'000;
  UserHidraw node("ft260", {0x06, 0x00, 0xFF});
  Bridge bridge(node);
  const auto line = openHidUart(node.address());
  ASSERT_TRUE(line->setLine({1'500'000, 1, false, false}));
  EXPECT_EQ(bridge.baud(), 1'500'000);
  auto chip = std::async(std::launch::async, [&] { return bridge.answer(kCount); });

  FalconFrameReader reader;
  int heard = 0;
  for (; heard < kCount; ++heard) {
    const FalconMotors motors{static_cast<std::int16_t>(heard % 4096),
                              static_cast<std::int16_t>(-(heard / 7) % 4096), 1};
    const FalconFrame command = encodeCommand({motors, true, 0});
    if (!line->write(command.data(), command.size())) break;
    std::optional<FalconFrame> frame;
    while (!frame) {
      std::uint8_t byte = 0;
      if (line->read(&byte, 1, 10.0) != 1) break;
      frame = reader.take(byte);
    }
    const auto reply = frame ? decodeReply(*frame) : std::nullopt;
    if (!reply || reply->counts != motors) break;
  }
  EXPECT_EQ(heard, kCount);
  EXPECT_EQ(reader.dropped(), 0U);
  EXPECT_EQ(chip.get(), kCount);

  node.unplug();
  std::uint8_t byte = 0;
  EXPECT_LT(line->read(&byte, 1, 10.0), 0);
  EXPECT_FALSE(line->write(&byte, 1));
}

TEST(HidUartOverHidapi, SaysWhatIsNotSuchABridge) {
  UserHidraw node("no-bridge", {0x05, 0x01});
  EXPECT_THROW((void)openHidUart(node.address()), Error) << "it takes no features";
  HidAddress slow;
  slow.vendor = 0x10C4;
  slow.product = 0xEA80;
  EXPECT_THROW((void)openHidUart(slow), Error);
}

TEST(RawHidOverHidapi, RendersAForceAndStopsWhenUnplugged) {
  UserHidraw node("raw", makeRawHidDescriptor());
  RawHidSettings settings;
  settings.stream.first_retry = 0.001;
  settings.ramp_in = 0.0;
  std::optional<RawHidDevice> device(
      std::in_place, [&] { return openHid(node.address()); }, settings);
  test::RawHidEmulator emulator;
  emulator.holdAt(Vec3(0.01, 0.0, 0.12));

  RawHidCommand command;
  double time = 0.0;
  const auto tick = [&] {
    (void)node.send(emulator.next());
    const bool is_valid = device->read(time += 1e-3).valid;
    device->write(Vec3(1, 2, 3));
    while (const auto output = node.receive(0.0)) command = test::RawHidEmulator::decode(*output);
    return is_valid;
  };
  const std::array<std::int16_t, 3> none{};
  ASSERT_TRUE(comesTrue([&] { return tick() && command.torques != none; }));
  EXPECT_EQ(command.flags, kRawHidDrive);

  node.unplug();
  ASSERT_TRUE(comesTrue([&] { return !device->read(time).valid; }));
  node.plugIn();
  ASSERT_TRUE(comesTrue([&] { return tick() && command.torques != none; }));
  EXPECT_EQ(device->status().counters.losses, 1U);

  device.reset();
  while (const auto output = node.receive(0.0)) command = test::RawHidEmulator::decode(*output);
  EXPECT_EQ(command.torques, none);
  EXPECT_EQ(command.flags, 0);
}

TEST(HidSwitchOverHidapi, IsReleasedWhenUnplugged) {
  UserHidraw node("pedal", {0x05, 0x01, 0x09, 0x06});
  HidSwitch pedal([&] { return openHid(node.address()); }, {HidSwitchKind::kKey, 0, 2, 0x05});
  ASSERT_TRUE(node.send({0, 0, 0x05, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(comesTrue([&] { return pedal.isPressed(); }));
  node.unplug();
  EXPECT_TRUE(comesTrue([&] { return !pedal.isPressed(); }));
}

}  // namespace
}  // namespace tandem
