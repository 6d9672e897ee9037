#include "falcon/src/hid/hid_stream.h"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include "devices/fake_hid_port.h"

namespace tandem {
namespace {

using test::Bytes;
using test::comesTrue;
using test::FakeHidDevice;

/// Accepts reports that begin with 1, and sends a count.
class Client final : public HidClient {
 public:
  [[nodiscard]] bool takeReport(const std::uint8_t* report, std::size_t size,
                                double) noexcept override {
    if (report[0] != 1) return false;
    const std::lock_guard held(mutex_);
    heard_.emplace_back(report, report + size);
    return true;
  }
  [[nodiscard]] HidReport giveReport(double) noexcept override {
    return test::makeReport({0, ++given_});
  }
  [[nodiscard]] HidReport giveLastReport(double) noexcept override {
    return test::makeReport({0, 0xFF, 0xFF});
  }
  void setConnected(bool is_connected) noexcept override { is_connected ? ++comings : ++goings; }

  [[nodiscard]] std::vector<Bytes> heard() const {
    const std::lock_guard held(mutex_);
    return heard_;
  }
  std::atomic<int> comings{0}, goings{0};

 private:
  mutable std::mutex mutex_;
  std::vector<Bytes> heard_;
  std::uint8_t given_ = 0;
};

HidStreamSettings makeQuick(double write_period) {
  HidStreamSettings settings;
  settings.write_period = write_period;
  settings.first_retry = 0.001;
  settings.longest_retry = 0.01;
  return settings;
}

TEST(HidStream, LosesNoReportAndKeepsTheirOrder) {
  constexpr int kCount = 5000;
  FakeHidDevice fake;
  Client client;
  HidStream stream(fake.opener(), client, makeQuick(0.0));
  for (int i = 0; i < kCount; ++i)
    fake.send({1, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8)});
  ASSERT_TRUE(comesTrue([&] { return stream.counters().reports == kCount; }));
  const std::vector<Bytes> heard = client.heard();
  ASSERT_EQ(heard.size(), static_cast<std::size_t>(kCount));
  for (int i = 0; i < kCount; ++i) ASSERT_EQ(heard[i][1] | heard[i][2] << 8, i);
  EXPECT_TRUE(fake.outputs().empty()) << "without a period nothing is written";
}

TEST(HidStream, CountsWhatTheClientRefuses) {
  FakeHidDevice fake;
  Client client;
  HidStream stream(fake.opener(), client, makeQuick(0.0));
  fake.send({2, 2});
  fake.send({1, 2});
  ASSERT_TRUE(comesTrue([&] { return stream.counters().reports == 2; }));
  EXPECT_EQ(stream.counters().refused, 1U);
  EXPECT_EQ(client.heard().size(), 1U);
}

TEST(HidStream, WritesInItsPeriodAndSaysTheLastWords) {
  FakeHidDevice fake;
  Client client;
  {
    HidStream stream(fake.opener(), client, makeQuick(0.001));
    ASSERT_TRUE(comesTrue([&] { return stream.counters().written >= 20; }));
  }
  const std::vector<Bytes> outputs = fake.outputs();
  ASSERT_GE(outputs.size(), 21U);
  for (std::size_t i = 0; i < 20; ++i)
    EXPECT_EQ(outputs[i], (Bytes{0, static_cast<std::uint8_t>(i + 1)}));
  EXPECT_EQ(outputs.back(), (Bytes{0, 0xFF, 0xFF}));
  EXPECT_EQ(client.goings, 1);
}

// The device is there and its motors may be on. It gets the last report also after a bad one.
TEST(HidStream, AWriteThatFailsIsFollowedByTheLastWords) {
  FakeHidDevice fake;
  Client client;
  HidStream stream(fake.opener(), client, makeQuick(0.001));
  ASSERT_TRUE(comesTrue([&] { return stream.counters().written >= 3; }));
  fake.refuseWrites(2);  // includes the first of the last reports
  ASSERT_TRUE(comesTrue([&] { return client.goings == 1; }));
  ASSERT_TRUE(comesTrue([&] { return stream.isConnected(); }));
  const std::vector<Bytes> outputs = fake.outputs();
  EXPECT_NE(std::find(outputs.begin(), outputs.end(), Bytes{0, 0xFF, 0xFF}), outputs.end());
}

TEST(HidStream, ASlowWriteHoldsUpNoReading) {
  FakeHidDevice fake;
  std::atomic<bool> may_go_on{false};
  fake.on_output = [&](const Bytes&) { (void)comesTrue([&] { return may_go_on.load(); }); };
  Client client;
  HidStream stream(fake.opener(), client, makeQuick(0.001));
  for (int i = 0; i < 100; ++i) fake.send({1, 0});
  EXPECT_TRUE(comesTrue([&] { return client.heard().size() == 100; }));
  EXPECT_LE(fake.outputs().size(), 1U) << "the first write has not come back";
  may_go_on = true;
  EXPECT_TRUE(comesTrue([&] { return stream.counters().write_misses > 0; }));
}

TEST(HidStream, ComesBackAfterEveryUnplugging) {
  FakeHidDevice fake;
  Client client;
  HidStream stream(fake.opener(), client, makeQuick(0.001));
  for (int round = 1; round <= 3; ++round) {
    EXPECT_TRUE(stream.isConnected());
    fake.setPluggedIn(false);
    ASSERT_TRUE(comesTrue([&] { return stream.trouble() == "the fake is not plugged in"; }));
    EXPECT_FALSE(stream.isConnected());
    EXPECT_EQ(client.goings, round);
    fake.setPluggedIn(true);
    ASSERT_TRUE(comesTrue([&] { return stream.isConnected(); }));
    EXPECT_EQ(client.comings, round + 1);
    EXPECT_EQ(stream.counters().losses, static_cast<std::uint64_t>(round));
    fake.send({1, 7});
    ASSERT_TRUE(
        comesTrue([&] { return client.heard().size() == static_cast<std::size_t>(round); }));
  }
  EXPECT_EQ(stream.name(), "HID fake");
}

TEST(HidStream, AnOpenerMayThrowAnythingAndGiveNothing) {
  FakeHidDevice fake;
  Client client;
  std::atomic<int> opened{0};
  const HidOpener open = [&]() -> std::unique_ptr<HidPort> {
    if (++opened == 2) throw 42;
    if (opened == 3) return nullptr;
    return fake.opener()();
  };
  HidStream stream(open, client, makeQuick(0.001));
  fake.setPluggedIn(false);
  ASSERT_TRUE(comesTrue([&] { return opened >= 4; }));
  fake.setPluggedIn(true);
  EXPECT_TRUE(comesTrue([&] { return stream.isConnected(); }));
  EXPECT_EQ(stream.trouble(), "");

  const HidOpener give_nothing = [] { return std::unique_ptr<HidPort>(); };
  EXPECT_THROW((void)HidStream(give_nothing, client), Error);
}

TEST(HidStream, EndsWhileItLooksForTheDevice) {
  FakeHidDevice fake;
  Client client;
  HidStreamSettings settings = makeQuick(0.0);
  settings.first_retry = settings.longest_retry = 3600.0;
  HidStream stream(fake.opener(), client, settings);
  fake.setPluggedIn(false);
  ASSERT_TRUE(comesTrue([&] { return client.goings == 1; }));
}

// The stream ends before its threads have run, and while it reopens the device.
TEST(HidStream, EndsRightAfterItHasConnected) {
  FakeHidDevice fake;
  Client client;
  for (int i = 0; i < 20; ++i) HidStream stream(fake.opener(), client, makeQuick(0.001));
  EXPECT_EQ(client.comings, 20);
  EXPECT_EQ(client.goings, 20);

  std::atomic<int> opened{0};
  const HidOpener open = [&] {
    std::unique_ptr<HidPort> port = fake.opener()();
    // Long enough for the stream's end to begin. The test also holds if it has not.
    if (++opened > 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return port;
  };
  {
    HidStream stream(open, client, makeQuick(0.001));
    fake.refuseWrites(1);
    ASSERT_TRUE(comesTrue([&] { return opened == 2; }));
  }
  EXPECT_EQ(client.goings, client.comings);
}

TEST(HidStream, RefusesSettingsOutOfRangeAndADeviceThatIsNotThere) {
  FakeHidDevice fake;
  Client client;
  HidStreamSettings settings;
  settings.write_period = -1.0;
  EXPECT_THROW((void)HidStream(fake.opener(), client, settings), std::invalid_argument);
  settings = {};
  settings.first_retry = 0.0;
  EXPECT_THROW((void)HidStream(fake.opener(), client, settings), std::invalid_argument);
  settings = {};
  settings.longest_retry = 0.01;
  EXPECT_THROW((void)HidStream(fake.opener(), client, settings), std::invalid_argument);
  fake.setPluggedIn(false);
  EXPECT_THROW((void)HidStream(fake.opener(), client), Error);
}

}  // namespace
}  // namespace tandem
