#include "falcon/src/hid/raw_hid_report.h"

#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

using Torques = std::array<std::int16_t, 3>;

const RawHidState kState{0x1234, {100, -200, 32767}, 7, 5, 0xDEADBEEF};
const RawHidCommand kCommand{0xFFFF, {1, -1, -32767}, kRawHidDrive};

/// Builds a report from its leading bytes, zeros, and the CRC. CRCs are from Python's
/// binascii.crc_hqx.
RawHidBytes makeGolden(std::initializer_list<int> head, int crc) {
  RawHidBytes bytes{};
  std::size_t i = 0;
  for (const int byte : head) bytes[i++] = static_cast<std::uint8_t>(byte);
  bytes[62] = static_cast<std::uint8_t>(crc);
  bytes[63] = static_cast<std::uint8_t>(crc >> 8);
  return bytes;
}

const RawHidBytes kGoldenState = makeGolden(
    {1, 'S', 0x34, 0x12, 0x64, 0, 0x38, 0xFF, 0xFF, 0x7F, 7, 5, 0xEF, 0xBE, 0xAD, 0xDE}, 0x40BA);
const RawHidBytes kGoldenCommand =
    makeGolden({1, 'C', 0xFF, 0xFF, 1, 0, 0xFF, 0xFF, 0x01, 0x80, 1}, 0xCD98);

void seal(RawHidBytes& bytes) {
  const std::uint16_t crc = computeCrc16(bytes.data(), 62);
  bytes[62] = static_cast<std::uint8_t>(crc);
  bytes[63] = static_cast<std::uint8_t>(crc >> 8);
}

bool isState(const RawHidBytes& bytes, std::size_t size = kRawHidSize) {
  return decodeRawState(bytes.data(), size).has_value();
}
bool isCommand(const RawHidBytes& bytes) {
  return decodeRawCommand(bytes.data(), bytes.size()).has_value();
}

TEST(RawHidReport, GoldenBytesAreWhatTheDocumentSays) {
  EXPECT_EQ(encodeRawState(kState), kGoldenState);
  EXPECT_EQ(encodeRawCommand(kCommand), kGoldenCommand);
  const auto state = decodeRawState(kGoldenState.data(), kGoldenState.size());
  ASSERT_TRUE(state);
  EXPECT_EQ(state->number, kState.number);
  EXPECT_EQ(state->counts, kState.counts);
  EXPECT_TRUE(state->isHomed());
  EXPECT_EQ(state->buttons, 5);
  EXPECT_EQ(state->time_us, 0xDEADBEEFU);
  const auto command = decodeRawCommand(kGoldenCommand.data(), kGoldenCommand.size());
  ASSERT_TRUE(command);
  EXPECT_EQ(command->number, kCommand.number);
  EXPECT_EQ(command->torques, kCommand.torques);
  EXPECT_EQ(command->flags, kRawHidDrive);
}

TEST(RawHidReport, TheCrcIsCcittFalse) {
  const std::uint8_t check[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(computeCrc16(check, sizeof check), 0x29B1);
  EXPECT_EQ(computeCrc16(check, 0), 0xFFFF);
}

TEST(RawHidReport, EveryTurnedBitIsSeen) {
  for (std::size_t bit = 0; bit < 8 * kRawHidSize; ++bit) {
    RawHidBytes state = kGoldenState, command = kGoldenCommand;
    state[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    command[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(isState(state)) << bit;
    EXPECT_FALSE(isCommand(command)) << bit;
  }
}

TEST(RawHidReport, RefusesWhatTheFormatDoesNotKnow) {
  EXPECT_FALSE(isState(kGoldenState, kRawHidSize - 1));
  EXPECT_FALSE(isState(kGoldenState, 0));
  EXPECT_FALSE(isState(kGoldenCommand)) << "the other kind";
  EXPECT_FALSE(isCommand(kGoldenState));
  const auto changed = [](RawHidBytes bytes, std::size_t at, std::uint8_t value) {
    bytes[at] = value;
    seal(bytes);
    return bytes;
  };
  EXPECT_FALSE(isState(changed(kGoldenState, 0, 2))) << "another version";
  EXPECT_FALSE(isState(changed(kGoldenState, 10, 8))) << "a fourth leg";
  EXPECT_FALSE(isState(changed(kGoldenState, 40, 1))) << "a byte without meaning";
  EXPECT_FALSE(isCommand(changed(kGoldenCommand, 10, 4))) << "a flag without meaning";
  EXPECT_FALSE(isCommand(changed(kGoldenCommand, 11, 1)));
  EXPECT_FALSE(isCommand(changed(kGoldenCommand, 10, 0))) << "torques, but motors off";
}

TEST(RawHidReport, WithoutDriveNoTorqueIsEncoded) {
  const RawHidBytes bytes = encodeRawCommand({1, {1000, 1000, 1000}, kRawHidHome});
  const auto command = decodeRawCommand(bytes.data(), bytes.size());
  ASSERT_TRUE(command);
  EXPECT_EQ(command->torques, Torques{});
  EXPECT_EQ(command->flags, kRawHidHome);
}

TEST(RawHidReport, TorquesAreScaledAlikeAndNeverWrap) {
  EXPECT_EQ(makeRawTorques(Vec3(0.05, -0.1, 0.0)), (Torques{1000, -2000, 0}));
  EXPECT_EQ(makeRawTorques(Vec3(4.0, -1.0, 0.0)), (Torques{32767, -8192, 0}));
  constexpr double kMost = std::numeric_limits<double>::max();
  for (const Torques& huge :
       {makeRawTorques(Vec3(kMost, -kMost, 1)), makeRawTorques(Vec3(1e300, 0, 0))})
    for (const std::int16_t torque : huge) EXPECT_GE(torque, -32767);
  EXPECT_EQ(makeRawTorques(Vec3(std::numeric_limits<double>::quiet_NaN(), 1, 1)), Torques{});
  EXPECT_EQ(makeRawTorques(Vec3(1, -std::numeric_limits<double>::infinity(), 1)), Torques{});
}

TEST(RawHidReport, AReportWithoutIdentifierHasAZeroInFront) {
  const HidReport report = toReport(kGoldenCommand);
  EXPECT_EQ(report.size, 65U);
  EXPECT_EQ(report.bytes[0], 0);
  EXPECT_TRUE(std::equal(kGoldenCommand.begin(), kGoldenCommand.end(), report.bytes.begin() + 1));
}

TEST(RawHidReport, TheDescriptorIsOfUsagePageFfab) {
  const std::vector<std::uint8_t> descriptor = makeRawHidDescriptor();
  ASSERT_EQ(descriptor.size(), 28U);
  EXPECT_EQ(descriptor[1] | descriptor[2] << 8, 0xFFAB);
  EXPECT_EQ(descriptor[4] | descriptor[5] << 8, 0x0200);
  EXPECT_EQ(descriptor.back(), 0xC0);
}

TEST(RawHidReport, WhatIsDecodedIsWhatWasEncoded) {
  constexpr std::uint64_t kSeed = 5;
  RecordProperty("seed", static_cast<int>(kSeed));
  test::Random random(kSeed);
  for (int i = 0; i < 2000; ++i) {
    RawHidState state;
    state.number = static_cast<std::uint16_t>(random.below(65536));
    for (std::int16_t& count : state.counts)
      count = static_cast<std::int16_t>(random.below(65536) - 32768);
    state.homed = static_cast<std::uint8_t>(random.below(8));
    state.time_us = static_cast<std::uint32_t>(random.below(1 << 30));
    const RawHidBytes bytes = encodeRawState(state);
    const auto decoded = decodeRawState(bytes.data(), bytes.size());
    ASSERT_TRUE(decoded) << "seed " << kSeed;
    ASSERT_EQ(encodeRawState(*decoded), bytes);
    ASSERT_EQ(decoded->counts, state.counts);
  }
}

}  // namespace
}  // namespace tandem
