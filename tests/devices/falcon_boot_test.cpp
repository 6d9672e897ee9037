#include "falcon/src/novint/falcon_boot.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tandem/coordination/types.h"

#include "devices/falcon_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::FalconRig;

// Boot loader bytes arrive in every possible way, on both kinds of line.
TEST(FalconBoot, LoadsTheFirmware) {
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
    FalconEmulatorSettings device;
    device.has_modem_lines = (i & 1) != 0;
    device.answers_with_zero = (i & 2) != 0;
    device.echoes_with_dc3 = (i & 4) != 0;
    device.has_usb_times = (i & 8) != 0;
    FalconRig rig(device);
    EXPECT_TRUE(rig.runUntil(FalconState::kLoading, 2.0));
    EXPECT_TRUE(rig.runUntil(FalconState::kUnhomed, 10.0));
    EXPECT_EQ(rig.emulator.state(), FalconEmulator::State::kRunning);
    EXPECT_EQ(rig.driver.status().boots, 1U);
    EXPECT_EQ(rig.driver.status().loaded, rig.driver.status().image);
    EXPECT_EQ(rig.driver.status().fault, FalconFault::kNone);
  }
}

// The speed is an integer fraction of 3 MHz, so every FTDI chip makes exactly it.
TEST(FalconBoot, LoadsAtASpeedThatEveryChipCanMake) {
  FalconBoot boot(makeSyntheticFirmware(1));
  const std::array<std::uint8_t, 4> answer = {0x0A, 0x44, 0x2C, 0x0D};
  boot.start(0.0);
  double now = 0.0;
  while (boot.phase() != FalconBoot::Phase::kCalling && now < 1.0) (void)boot.advance(now += 0.001);
  (void)boot.advance(now);
  boot.take(answer.data(), answer.size(), now);
  ASSERT_EQ(boot.phase(), FalconBoot::Phase::kTiming);
  const LineStep step = boot.advance(now);
  ASSERT_TRUE(step.line);
  EXPECT_EQ(step.line->baud, 3000000 / 21);
  EXPECT_FALSE(step.line->dtr);
}

TEST(FalconBoot, FirmwareThatRunsIsLeftAlone) {
  FalconRig rig(test::readyDevice());
  EXPECT_TRUE(rig.runUntil(FalconState::kReady, 0.5));
  EXPECT_EQ(rig.driver.status().loaded, 0U);
}

struct Trouble {
  const char* name;
  FalconFault fault;
  void (*make)(FalconMishaps&, int tries);
};

const std::array<Trouble, 4> kTroubles = {{
    {"silent", FalconFault::kNoBootLoader,
     [](FalconMishaps& m, int n) { m.silent_calls = 20 * n; }},
    {"wrong echo", FalconFault::kWrongBootEcho, [](FalconMishaps& m, int n) { m.wrong_loads = n; }},
    {"echo stops", FalconFault::kNoBootEcho, [](FalconMishaps& m, int n) { m.stopped_loads = n; }},
    {"dead start", FalconFault::kNotRunning, [](FalconMishaps& m, int n) { m.dead_starts = n; }},
}};

TEST(FalconBoot, TriesAgainUntilItWorks) {
  constexpr std::uint64_t kSeed = 70;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (const Trouble& trouble : kTroubles) {
    for (const bool has_modem_lines : {true, false}) {
      SCOPED_TRACE(trouble.name);
      FalconEmulatorSettings device;
      device.has_modem_lines = has_modem_lines;
      FalconRig rig(device);
      trouble.make(rig.emulator.mishaps, 3);
      rig.emulator.mishaps.load_byte = static_cast<std::size_t>(random.below(1000));
      ASSERT_TRUE(rig.runUntil(FalconState::kUnhomed, 60.0));
      // The status shows the fault until the device is ready.
      EXPECT_EQ(rig.driver.status().fault, trouble.fault);
      EXPECT_EQ(rig.driver.status().faults, 0U);
    }
  }
}

TEST(FalconBoot, GivesUpWithTheReasonAndBeginsAnew) {
  for (const Trouble& trouble : kTroubles) {
    SCOPED_TRACE(trouble.name);
    FalconSettings settings;
    settings.boot.tries = 2;
    FalconRig rig({}, settings);
    trouble.make(rig.emulator.mishaps, 2);
    ASSERT_TRUE(rig.runUntil(FalconState::kFault, 20.0));
    EXPECT_EQ(rig.driver.status().fault, trouble.fault);
    EXPECT_STRNE(textOf(trouble.fault), "unknown fault");
    EXPECT_TRUE(rig.runUntil(FalconState::kUnhomed, 20.0));
  }
}

TEST(FalconBoot, WithoutAnImageItSaysSo) {
  FalconEmulator emulator;
  FalconDriver driver(FalconSettings{});
  driver.connect(0.0);
  for (double now = 0.0; now < 0.5; now += 0.001) (void)driver.advance(now);
  EXPECT_EQ(driver.status().state, FalconState::kFault);
  EXPECT_EQ(driver.status().fault, FalconFault::kNoFirmware);
}

TEST(FalconBoot, AnyBytesAtAnyTimeDoNoHarm) {
  constexpr std::uint64_t kSeed = 71;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int run = 0; run < 200; ++run) {
    FalconBoot boot(makeSyntheticFirmware(1, 64));
    double now = random.uniform(0.0, 10.0);
    boot.start(now);
    for (int i = 0; i < 500; ++i) {
      std::array<std::uint8_t, 32> bytes;
      for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
      if (random.below(3) == 0) bytes = {0x0A, 0x44, 0x2C, 0x0D, 'A', 'A'};
      boot.take(bytes.data(), static_cast<std::size_t>(random.below(32)), now);
      const LineStep step = boot.advance(now);
      ASSERT_LE(step.count, step.bytes.size());
      ASSERT_LE(boot.loaded(), boot.size());
      now += random.uniform(0.0, 0.2);
    }
  }
}

std::string refusalOf(const std::vector<std::uint8_t>& bytes) {
  const char* fault = findFaultOfFirmware(bytes.data(), bytes.size());
  return fault ? fault : "";
}

TEST(FirmwareImage, ASyntheticOneIsRight) {
  EXPECT_EQ(refusalOf(makeSyntheticFirmware(1).bytes), "");
  EXPECT_EQ(refusalOf(makeSyntheticFirmware(2, 100000).bytes), "");
  EXPECT_EQ(makeSyntheticFirmware(3).bytes, makeSyntheticFirmware(3).bytes);
  BootTableReader table;
  for (const std::uint8_t byte : makeSyntheticFirmware(1, 20).bytes) table.take(byte);
  EXPECT_EQ(table.entry(), 0x3F8002U);
  EXPECT_EQ(table.blocks(), 1U);
  EXPECT_EQ(table.words(), 20U);
}

TEST(FirmwareImage, EachFaultIsNamed) {
  const auto good = makeSyntheticFirmware(1, 4).bytes;
  auto bytes = good;
  EXPECT_EQ(refusalOf({}), "it is empty");
  EXPECT_EQ(refusalOf(std::vector<std::uint8_t>(kMostFirmware + 1)), "it is larger than 256 KiB");
  for (std::size_t count = 1; count < good.size(); ++count) {
    bytes.assign(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_EQ(refusalOf(bytes), "it ends before its boot table does");
  }
  bytes = good;
  bytes[0] ^= 1;
  EXPECT_EQ(refusalOf(bytes), "it does not begin with AA 08, the key of a C28x boot table");
  bytes = good;
  bytes.push_back(0);
  EXPECT_EQ(refusalOf(bytes), "bytes follow the end of its boot table");
  for (const std::size_t high : {19U, 25U}) {  // high byte of the entry, of the block's address
    bytes = good;
    bytes[high] = 0x10;
    EXPECT_EQ(refusalOf(bytes), "a block lies outside of the processor's memory");
  }
  bytes.assign(good.begin(), good.begin() + 22);
  bytes.resize(24);
  EXPECT_EQ(refusalOf(bytes), "it holds no program");
}

TEST(FirmwareImage, IsReadFromAFileOrRefusedInOneLine) {
  const std::string path = ::testing::TempDir() + "tandem_firmware_test.bin";
  const auto good = makeSyntheticFirmware(5).bytes;
  const auto write = [&path](const std::vector<std::uint8_t>& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  };
  write(good);
  EXPECT_EQ(readFirmware(path).bytes, good);
  write({0x4D, 0x5A});
  const auto messageOf = [](const std::string& file) -> std::string {
    try {
      (void)readFirmware(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(messageOf(path), path +
                                 ": is no firmware image of a Falcon: it does not begin with AA "
                                 "08, the key of a C28x boot table; take the file from your "
                                 "Falcon's software again");
  EXPECT_NE(messageOf(path + ".not").find("cannot be read (No such file"), std::string::npos);
  EXPECT_NE(messageOf(::testing::TempDir()).find("; "), std::string::npos);
}

}  // namespace
}  // namespace tandem
