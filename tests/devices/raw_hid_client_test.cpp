#include "raw_hid_client.h"

#include <gtest/gtest.h>

#include "devices/raw_hid_emulator.h"

// Both ages to the microsecond, in a time that is told; raw_hid_device_test.cpp has the threads.

namespace tandem {
namespace {

using Torques = falcon_detail::RawHidClient::Torques;

constexpr Torques kTorques{100, -200, 300};

class RawHidClientTest : public testing::Test {
 protected:
  RawHidClientTest() { client_.setConnected(true); }

  [[nodiscard]] bool hear(double now) {
    const test::Bytes report = emulator_.next();
    return client_.takeReport(report.data(), report.size(), now);
  }
  [[nodiscard]] RawHidCommand give(double now) {
    return test::RawHidEmulator::decode(test::bytesOf(client_.giveReport(now)));
  }
  [[nodiscard]] bool drives(double now) {
    const RawHidCommand command = give(now);
    EXPECT_EQ(command.torques, command.flags == kRawHidDrive ? kTorques : Torques{});
    return command.flags == kRawHidDrive;
  }

  falcon_detail::RawHidClient client_;
  test::RawHidEmulator emulator_;
};

TEST_F(RawHidClientTest, DrivesForTwentyMillisecondsAfterAReport) {
  ASSERT_TRUE(hear(0.0));
  client_.command(kTorques);
  EXPECT_TRUE(drives(0.0));
  EXPECT_TRUE(drives(0.020));
  EXPECT_FALSE(drives(0.020001));
  ASSERT_TRUE(hear(0.021));
  EXPECT_TRUE(drives(0.022));
}

TEST_F(RawHidClientTest, DrivesForFiftyMillisecondsAfterACommand) {
  client_.command(kTorques);
  ASSERT_TRUE(hear(0.0));
  EXPECT_TRUE(drives(0.0));
  ASSERT_TRUE(hear(0.045));
  EXPECT_TRUE(drives(0.050));
  EXPECT_FALSE(drives(0.050001));
  client_.command(kTorques);
  EXPECT_TRUE(drives(0.060)) << "the same torques again are a command, too";
}

TEST_F(RawHidClientTest, ADeviceThatRepeatsItselfGrowsOld) {
  const test::Bytes report = emulator_.next();
  client_.command(kTorques);
  EXPECT_TRUE(client_.takeReport(report.data(), report.size(), 0.0));
  EXPECT_TRUE(client_.takeReport(report.data(), report.size(), 0.015));
  EXPECT_TRUE(drives(0.020));
  EXPECT_FALSE(drives(0.021));
}

TEST_F(RawHidClientTest, LooksForTheIndexMarksUntilHomed) {
  EXPECT_EQ(give(0.0).flags, kRawHidHome) << "nothing is known";
  emulator_.setHomed(false);
  ASSERT_TRUE(hear(0.0));
  client_.command(kTorques);
  EXPECT_EQ(give(0.001).flags, kRawHidHome);
  EXPECT_EQ(give(0.001).torques, Torques{});
  emulator_.setHomed(true);
  ASSERT_TRUE(hear(0.002));
  EXPECT_TRUE(drives(0.003));
}

TEST_F(RawHidClientTest, UnpluggedItForgets) {
  ASSERT_TRUE(hear(0.0));
  client_.command(kTorques);
  ASSERT_TRUE(drives(0.0));
  client_.setConnected(false);
  EXPECT_FALSE(drives(0.001));
  client_.setConnected(true);
  EXPECT_FALSE(drives(0.002));
  EXPECT_FALSE(client_.newest().state.isHomed());
}

TEST_F(RawHidClientTest, CountsNumbersThatAreMissingAlsoWhereTheyWrap) {
  for (int i = 0; i < 65'530; ++i) (void)emulator_.next();
  ASSERT_TRUE(hear(0.0));
  for (int i = 0; i < 9; ++i) (void)emulator_.next();
  ASSERT_TRUE(hear(0.01));
  EXPECT_EQ(client_.lost(), 9U);
}

TEST_F(RawHidClientTest, CommandsAreNumberedAndTheLastIsOff) {
  const std::uint16_t first = give(0.0).number;
  EXPECT_EQ(give(0.001).number, first + 1);
  ASSERT_TRUE(hear(0.0));
  client_.command(kTorques);
  const RawHidCommand last =
      test::RawHidEmulator::decode(test::bytesOf(client_.giveLastReport(0.001)));
  EXPECT_EQ(last.number, first + 2);
  EXPECT_EQ(last.flags, 0);
  EXPECT_EQ(last.torques, Torques{});
}

}  // namespace
}  // namespace tandem
