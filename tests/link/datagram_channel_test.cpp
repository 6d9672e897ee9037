#include "tandem/coordination/datagram_channel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr double kPeriod = 1e-3;  // time between datagrams [s]

/// Eight bytes that encode the number.
Bytes makeDatagram(std::uint64_t number) {
  Bytes bytes(sizeof number);
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

struct Arrived {
  Bytes bytes;
  double sent, due;  // [s]
  bool is_reordered;

  [[nodiscard]] std::uint64_t number() const {
    std::uint64_t n = 0;
    std::memcpy(&n, bytes.data(), std::min(sizeof n, bytes.size()));
    return n;
  }
};

void takeAll(DatagramChannel& channel, double now, std::vector<Arrived>& arrived) {
  while (const auto delivery = channel.takeDue(now))
    arrived.push_back({Bytes(delivery->bytes.data, delivery->bytes.data + delivery->bytes.size),
                       delivery->sent, delivery->due, delivery->is_reordered});
}

Entrance send(DatagramChannel& channel, const Bytes& bytes, const ChannelConditions& conditions,
              double now) {
  return channel.send({bytes.data(), bytes.size()}, conditions, now);
}

/// Sends `count` datagrams, one each period, and returns all that come out.
std::vector<Arrived> pass(DatagramChannel& channel, const ChannelConditions& conditions,
                          std::uint64_t count) {
  std::vector<Arrived> arrived;
  for (std::uint64_t n = 0; n < count; ++n) {
    const double now = kPeriod * static_cast<double>(n);
    takeAll(channel, now, arrived);
    (void)send(channel, makeDatagram(n), conditions, now);
  }
  takeAll(channel, 1e9, arrived);
  return arrived;
}

void expectBalance(const DatagramChannelCounts& c) {
  EXPECT_EQ(c.sent - c.cut_off - c.too_long - c.lost + c.duplicated, c.delivered + c.overflowed);
}

TEST(DatagramChannel, DelaysAndKeepsBytes) {
  DatagramChannel channel(Direction::kForward, 4, 16);
  const Bytes sent = {1, 2, 3, 250};
  EXPECT_EQ(channel.nextDue(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(send(channel, sent, {{.delay = 0.05}}, 1.0), Entrance::kOnItsWay);
  EXPECT_EQ(channel.nextDue(), 1.05);
  EXPECT_FALSE(channel.takeDue(std::nextafter(1.05, 0.0)));
  std::vector<Arrived> arrived;
  takeAll(channel, 1.05, arrived);
  ASSERT_EQ(arrived.size(), 1U);
  EXPECT_EQ(arrived[0].bytes, sent);
  EXPECT_EQ(arrived[0].sent, 1.0);
  EXPECT_EQ(arrived[0].due, 1.05);
}

// Compares number by number and bit by bit: the channel adds none and keeps none back.
TEST(DatagramChannel, DoesWhatTheFatesSay) {
  for (const std::uint64_t seed : {0U, 7U, 99U}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const ChannelConditions conditions{{0.02, 0.01, 0.1, 0.2, 0.1, seed}, 0.1};
    constexpr std::uint64_t kCount = 5000;
    DatagramChannel channel(Direction::kBack, 1000, 8);
    std::multimap<double, Bytes> expected;
    for (std::uint64_t n = 0; n < kCount; ++n) {
      const PacketFate fate = computeFate(conditions.impairments, Direction::kBack, n);
      if (fate.is_lost) continue;
      for (const Copy copy : {Copy::kFirst, Copy::kDuplicate}) {
        if (copy == Copy::kDuplicate && !fate.is_duplicated) continue;
        Bytes bytes = makeDatagram(n);
        if (const auto bit = computeCorruptBit(0.1, seed, Direction::kBack, n, copy, 8))
          bytes[*bit / 8] = static_cast<std::uint8_t>(bytes[*bit / 8] ^ (1U << (*bit % 8)));
        const double delay = copy == Copy::kFirst ? fate.delay : fate.duplicate_delay;
        expected.emplace(kPeriod * static_cast<double>(n) + delay, bytes);
      }
    }
    std::multimap<double, Bytes> seen;
    double last = 0.0;
    for (const Arrived& one : pass(channel, conditions, kCount)) {
      EXPECT_GE(one.due, last);
      last = one.due;
      seen.emplace(one.due, one.bytes);
    }
    EXPECT_EQ(seen, expected);
    expectBalance(channel.counts());
    EXPECT_GT(channel.counts().overtaken, 0U);
    EXPECT_EQ(channel.counts().overflowed, 0U);
  }
}

TEST(DatagramChannel, CorruptsExactlyOneBit) {
  DatagramChannel channel(Direction::kForward, 4, 64);
  test::Random random(5);
  for (int n = 0; n < 1000; ++n) {
    Bytes bytes(static_cast<std::size_t>(1 + random.below(64)));
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
    (void)send(channel, bytes, {{}, 1.0}, 0.0);
    std::vector<Arrived> arrived;
    takeAll(channel, 0.0, arrived);
    ASSERT_EQ(arrived.size(), 1U);
    ASSERT_EQ(arrived[0].bytes.size(), bytes.size());
    int turned = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      turned += std::popcount(static_cast<unsigned>(bytes[i] ^ arrived[0].bytes[i]));
    ASSERT_EQ(turned, 1);
  }
  EXPECT_EQ(channel.counts().corrupted, 1000U);
}

TEST(DatagramChannel, KeepsOrderWhereAsked) {
  const Impairments jittery{0.02, 0.02, 0.0, 0.0, 0.0, 3};
  DatagramChannel loose(Direction::kForward, 1000, 8), strict(Direction::kForward, 1000, 8);
  (void)pass(loose, {jittery}, 2000);
  EXPECT_GT(loose.counts().overtaken, 100U);

  const std::vector<Arrived> arrived = pass(strict, {jittery, 0.0, true}, 2000);
  ASSERT_EQ(arrived.size(), 2000U);
  for (std::uint64_t n = 0; n < arrived.size(); ++n) {
    ASSERT_EQ(arrived[n].number(), n);
    // A datagram is never earlier than its own fate. It is later only because another was ahead.
    const double own =
        kPeriod * static_cast<double>(n) + computeFate(jittery, Direction::kForward, n).delay;
    ASSERT_EQ(arrived[n].due, n == 0 ? own : std::max(own, arrived[n - 1].due));
  }
  EXPECT_EQ(strict.counts().overtaken, 0U);
}

TEST(DatagramChannel, ReorderedOnesJumpTheQueueEvenIfOrderIsKept) {
  DatagramChannel channel(Direction::kForward, 1000, 8);
  const std::vector<Arrived> arrived =
      pass(channel, {{0.05, 0.0, 0.0, 0.0, 0.1, 3}, 0.0, true}, 2000);
  std::uint64_t jumped = 0;
  for (const Arrived& one : arrived) {
    EXPECT_EQ(one.due, one.is_reordered ? one.sent : one.sent + 0.05);
    jumped += one.is_reordered ? 1 : 0;
  }
  EXPECT_EQ(jumped, channel.counts().reordered);
  EXPECT_NEAR(static_cast<double>(jumped), 200.0, 5.0 * std::sqrt(2000 * 0.1 * 0.9));
}

TEST(DatagramChannel, ACutLosesWhatComesAndKeepsWhatIsUnderWay) {
  DatagramChannel channel(Direction::kForward, 8, 8);
  const ChannelConditions open{{.delay = 0.05}}, cut{{.delay = 0.05}, 0.0, false, true};
  EXPECT_EQ(send(channel, makeDatagram(0), open, 0.00), Entrance::kOnItsWay);
  EXPECT_EQ(send(channel, makeDatagram(1), cut, 0.01), Entrance::kCutOff);
  EXPECT_EQ(send(channel, makeDatagram(2), cut, 0.02), Entrance::kCutOff);
  EXPECT_EQ(send(channel, makeDatagram(3), open, 0.03), Entrance::kOnItsWay);
  std::vector<Arrived> arrived;
  takeAll(channel, 1.0, arrived);
  ASSERT_EQ(arrived.size(), 2U);
  EXPECT_EQ(arrived[0].number(), 0U);
  EXPECT_EQ(arrived[1].number(), 3U);
  EXPECT_EQ(channel.counts().cut_off, 2U);
  EXPECT_EQ(channel.counts().lost, 0U);
  expectBalance(channel.counts());
}

// An outage also consumes numbers: later datagrams keep their fates.
TEST(DatagramChannel, ACutDoesNotShiftFates) {
  const ChannelConditions lossy{{0.0, 0.0, 0.3, 0.0, 0.0, 7}};
  ChannelConditions cut = lossy;
  cut.is_cut = true;
  DatagramChannel channel(Direction::kForward, 8, 8);
  for (std::uint64_t n = 0; n < 500; ++n) {
    const bool is_out = n >= 100 && n < 200;
    const Entrance entrance = send(channel, makeDatagram(n), is_out ? cut : lossy, 0.0);
    const bool is_lost = computeFate(lossy.impairments, Direction::kForward, n).is_lost;
    ASSERT_EQ(entrance, is_out    ? Entrance::kCutOff
                        : is_lost ? Entrance::kLost
                                  : Entrance::kOnItsWay);
    while (channel.takeDue(0.0)) {
    }
  }
}

// The route becomes shorter at one moment: newer datagrams overtake those on the old route.
TEST(DatagramChannel, AStepOfTheDelayHoldsForWhatIsSentFromThenOn) {
  DatagramChannel channel(Direction::kForward, 8, 8);
  (void)send(channel, makeDatagram(0), {{.delay = 0.10}}, 0.00);
  (void)send(channel, makeDatagram(1), {{.delay = 0.02}}, 0.01);
  std::vector<Arrived> arrived;
  takeAll(channel, 1.0, arrived);
  ASSERT_EQ(arrived.size(), 2U);
  EXPECT_EQ(arrived[0].number(), 1U);
  EXPECT_EQ(arrived[0].due, 0.03);
  EXPECT_EQ(arrived[1].due, 0.10);
  EXPECT_EQ(channel.counts().overtaken, 1U);
}

TEST(DatagramChannel, DropsWhatIsBeyondItsRoom) {
  DatagramChannel channel(Direction::kForward, 3, 8);
  for (std::uint64_t n = 0; n < 5; ++n) (void)send(channel, makeDatagram(n), {{.delay = 1.0}}, 0.0);
  EXPECT_EQ(channel.counts().overflowed, 2U);
  std::vector<Arrived> arrived;
  takeAll(channel, 1.0, arrived);
  ASSERT_EQ(arrived.size(), 3U);
  for (std::uint64_t n = 0; n < 3; ++n) EXPECT_EQ(arrived[n].number(), n);

  for (std::uint64_t n = 5; n < 8; ++n)  // there is room again
    EXPECT_EQ(send(channel, makeDatagram(n), {{.delay = 1.0}}, 1.0), Entrance::kOnItsWay);
  EXPECT_EQ(channel.counts().overflowed, 2U);
}

TEST(DatagramChannel, TakesNoPartOfALongDatagram) {
  DatagramChannel channel(Direction::kForward, 3, 8);
  EXPECT_EQ(send(channel, Bytes(9), {}, 0.0), Entrance::kTooLong);
  EXPECT_EQ(channel.counts().too_long, 1U);
  EXPECT_FALSE(channel.takeDue(1.0));
  EXPECT_EQ(send(channel, Bytes(8), {}, 0.0), Entrance::kOnItsWay);
}

TEST(DatagramChannel, PassesOnADatagramWithoutBytes) {
  DatagramChannel channel(Direction::kForward, 3, 8);
  EXPECT_EQ(channel.send({}, {{}, 1.0}, 0.0), Entrance::kOnItsWay);
  const auto delivery = channel.takeDue(0.0);
  ASSERT_TRUE(delivery);
  EXPECT_EQ(delivery->bytes.size, 0U);
}

TEST(DatagramChannel, RefusesBadSetUp) {
  EXPECT_THROW(DatagramChannel(Direction::kForward, 0, 8), std::invalid_argument);
  EXPECT_THROW(DatagramChannel(Direction::kForward, 8, 0), std::invalid_argument);
  EXPECT_THROW(checkConditions({{}, 1.5}), std::invalid_argument);
  EXPECT_THROW(checkConditions({{}, NAN}), std::invalid_argument);
  EXPECT_THROW(checkConditions({{.delay = -1.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
