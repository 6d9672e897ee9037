// The emulator at commands, speeds and hosts other than those of our own driver. The strict hosts
// boot it as two published drivers do.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "devices/falcon_rig.h"
#include "falcon/src/novint/firmware_image.h"

namespace tandem {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A host that sends bytes and takes all that come within 10 ms.
class Host {
 public:
  explicit Host(const FalconEmulatorSettings& settings) : emulator(settings) {
    emulator.setLine({1'500'000, 1, false, false});
  }

  Bytes ask(const Bytes& bytes) {
    now_ += 0.001;
    emulator.take(bytes.data(), bytes.size(), now_);
    Bytes answer(256);
    now_ += 0.01;
    answer.resize(emulator.collect(answer.data(), answer.size(), now_));
    return answer;
  }

  std::optional<FalconReply> command(const std::array<std::int16_t, 3>& motors, int info) {
    FalconFrame frame = encodeReply({motors, 0, 0});  // does not clamp the numbers
    frame[13] = static_cast<std::uint8_t>('A' + info);
    const Bytes answer = ask({frame.begin(), frame.end()});
    if (answer.size() != frame.size()) return std::nullopt;
    std::copy(answer.begin(), answer.end(), frame.begin());
    return decodeReply(frame);
  }

  FalconEmulator emulator;

 private:
  double now_ = 1.0;
};

TEST(FalconEmulator, MotorsBeyondTheirRangeAreClampedOrIgnored) {
  for (const FalconOverrange overrange : {FalconOverrange::kClamp, FalconOverrange::kIgnore}) {
    FalconEmulatorSettings settings = test::readyDevice();
    settings.overrange = overrange;
    Host host(settings);
    ASSERT_TRUE(host.command({-100, 200, 300}, 1));
    EXPECT_EQ(host.emulator.strange(), 0U);
    const bool is_clamped = overrange == FalconOverrange::kClamp;
    EXPECT_EQ(host.command({32767, -32768, 4096}, 1).has_value(), is_clamped);
    EXPECT_EQ(host.emulator.strange(), 1U);
    EXPECT_EQ(host.emulator.command().motors,
              is_clamped ? (FalconMotors{4095, -4095, 4095}) : (FalconMotors{-100, 200, 300}));
    EXPECT_TRUE(host.command({4095, -4095, 0}, 1));
    EXPECT_EQ(host.emulator.strange(), 1U);
  }
}

TEST(FalconEmulator, UnknownInfoBitsAreTakenAndCounted) {
  Host host(test::readyDevice());
  for (int info = 0; info < 128; ++info) {
    ASSERT_TRUE(host.command({1, 2, 3}, info)) << info;
    EXPECT_EQ(host.emulator.command().homes, (info & 1) != 0);
    EXPECT_EQ(host.emulator.command().lights, info & 0x0e);
    EXPECT_EQ(host.emulator.command().motors, (FalconMotors{1, 2, 3}));
  }
  EXPECT_EQ(host.emulator.strange(), 112U);  // those above 0x0f
}

TEST(FalconEmulator, HomedBitsOutsideOfHomingModeAreASetting) {
  for (const bool always : {false, true}) {
    FalconEmulatorSettings settings = test::readyDevice();
    settings.always_tells_homed = always;
    Host host(settings);
    EXPECT_EQ(host.command({}, 1)->homed, 7);
    EXPECT_EQ(host.command({}, 0)->homed, always ? 7 : 0);
    EXPECT_EQ(host.command({}, 1)->homed, 7);
  }
}

// 1,456,312 Bd is asked for over FTD2XX; the chip makes 1.5 MBd of it.
TEST(FalconEmulator, SpeedsAreThoseThatTheChipMakes) {
  const std::vector<std::pair<int, bool>> speeds = {
      {1'500'000, true}, {1'456'312, true},   {1'470'000, true},  {1'530'000, true},
      {0, false},        {1'411'765, false},  {1'440'000, false}, {9600, false},
      {142'857, false},  {2'000'000, false},  {3'000'000, false}, {-1, false},
      {1, false},        {2147483647, false}, {1'600'000, true},  {1'900'000, false}};
  for (const auto& [baud, is_usable] : speeds) {
    Host host(test::readyDevice());
    host.emulator.setLine({baud, 1, false, false});
    EXPECT_EQ(host.command({}, 1).has_value(), is_usable) << baud;
  }
}

/// Boots as a strict published driver does. Returns false where that one gives up.
bool boot(Host& host, bool is_libusb) {
  const Bytes short_answer = {0x0A, 0x44, 0x2C, 0x0D}, long_answer = {0, 0x0A, 0x44, 0x2C, 0x0D};
  host.emulator.setLine({9600, 16, false, false});
  host.emulator.setLine({9600, 16, true, false});
  const Bytes answer = host.ask({0x0A, 0x43, 0x0D});
  if (answer != long_answer && !(is_libusb && answer == short_answer)) return false;
  host.emulator.setLine({is_libusb ? 142'857 : 140'000, 16, false, false});
  if (host.ask({'A'}) != Bytes{'A'}) return false;
  const Bytes image = makeSyntheticFirmware(1, 64).bytes;
  const std::size_t piece = is_libusb ? 62 : 128;
  for (std::size_t at = 0; at < image.size(); at += piece) {
    const Bytes sent(
        image.begin() + static_cast<std::ptrdiff_t>(at),
        image.begin() + static_cast<std::ptrdiff_t>(std::min(at + piece, image.size())));
    if (host.ask(sent) != sent) return false;
  }
  host.emulator.setLine({is_libusb ? 1'500'000 : 1'456'312, 1, false, false});
  return host.command({}, 1).has_value();
}

// Two drivers saw two devices: one bears an answer without 00, both need an echo without 13.
TEST(FalconEmulator, BootsInBothPublishedWays) {
  for (int i = 0; i < 8; ++i) {
    SCOPED_TRACE(i);
    const bool is_libusb = (i & 1) != 0, has_zero = (i & 2) != 0, has_dc3 = (i & 4) != 0;
    FalconEmulatorSettings settings;
    settings.answers_with_zero = has_zero;
    settings.echoes_with_dc3 = has_dc3;
    Host host(settings);
    EXPECT_EQ(boot(host, is_libusb), !has_dc3 && (is_libusb || has_zero));
  }
}

// Our driver behaves the same with either supposition about a real device.
TEST(FalconEmulator, DriverDoesNotDependOnWhatIsUnknown) {
  for (const bool always : {false, true}) {
    FalconEmulatorSettings settings = test::readyDevice();
    settings.always_tells_homed = always;
    test::FalconRig rig(settings);
    rig.emulator.plant().hold(Vec3(0.0, 0.0, 0.125));
    EXPECT_TRUE(rig.runUntil(FalconState::kReady, 0.5));
    rig.run(1.0, [&](double now) { rig.driver.command(Vec3(1e3, -1e3, 1e3), now); });
    EXPECT_EQ(rig.driver.status().state, FalconState::kReady);
    EXPECT_EQ(rig.emulator.strange(), 0U);
    EXPECT_NEAR(rig.emulator.felt().most_force, 8.0, 0.02);
  }
}

}  // namespace
}  // namespace tandem
