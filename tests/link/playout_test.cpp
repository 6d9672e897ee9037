#include "coordination/src/link/playout.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/refusal.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128.0;  // period of packets [s]
constexpr double kTick = 1e-3;
constexpr double kDelay = 0.05;
constexpr double kSkew = 1234.5;  // sender's clock minus own [s]

StatePacket makeNumbered(std::uint64_t sequence) {
  StatePacket packet;
  packet.sequence = sequence;
  return packet;
}

TEST(Playout, WithoutJitterGivesAtOnce) {
  Playout playout;
  for (std::uint64_t n = 0; n < 500; ++n) {
    const double now = static_cast<double>(n) * kPeriod + kDelay;
    EXPECT_EQ(playout.push(makeNumbered(n), now - kDelay + kSkew, now), Playout::Verdict::kWaits);
    const auto given = playout.pop(now, now + kTick);
    ASSERT_TRUE(given);
    EXPECT_EQ(given->packet.sequence, n);
    EXPECT_NEAR(given->time, now, 1e-9);
  }
  EXPECT_LT(playout.wait(), 1e-9);
}

/// Sends for a given time; the jitter draws the lateness of each packet. Gives the spread of the
/// playout delay late in the run, and how many of the packets sent then were played.
struct Spread {
  double least = 1e9, most = -1e9;
  int sent = 0, given = 0;
};
template <typename Draw>
Spread run(Playout& playout, double seconds, double drift, Draw draw) {
  struct Flight {
    std::uint64_t n;
    double arrival;
  };
  std::vector<Flight> flights;
  Spread spread;
  std::uint64_t n = 0;
  const auto ticks = static_cast<std::uint64_t>(seconds / kTick);
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    const double now = static_cast<double>(tick) * kTick;
    const bool counts = now > 0.6 * seconds;
    while (static_cast<double>(n) * kPeriod < now) {
      flights.push_back({n, static_cast<double>(n) * kPeriod + kDelay + draw()});
      spread.sent += counts;
      ++n;
    }
    for (std::size_t i = 0; i < flights.size();) {
      if (flights[i].arrival > now) {
        ++i;
        continue;
      }
      const double sent = static_cast<double>(flights[i].n) * kPeriod;
      (void)playout.push(makeNumbered(flights[i].n), sent * (1.0 + drift) + kSkew, now);
      flights.erase(flights.begin() + static_cast<std::ptrdiff_t>(i));
    }
    while (const auto given = playout.pop(now, now + kTick)) {
      if (!counts) continue;
      const double after = given->time - static_cast<double>(given->packet.sequence) * kPeriod;
      spread.least = std::min(spread.least, after);
      spread.most = std::max(spread.most, after);
      ++spread.given;
    }
  }
  return spread;
}

TEST(Playout, TurnsJitterIntoConstantDelay) {
  constexpr std::uint64_t kSeed = 20090401;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  Playout playout;
  const Spread spread = run(playout, 30.0, 0.0, [&] { return random.uniform(0.0, 0.02); });
  // Nearly all are played after the same delay, up to the tick that notices an arrival.
  EXPECT_LT(spread.most - spread.least, 0.002);
  EXPECT_NEAR(spread.least, kDelay + 0.02, 0.002);
  EXPECT_GT(spread.given, 0.97 * spread.sent);
}

TEST(Playout, FollowsClocksThatDrift) {
  test::Random random(3);
  for (const double drift : {-500e-6, 500e-6}) {
    Playout playout;
    const Spread spread = run(playout, 60.0, drift, [&] { return random.uniform(0.0, 0.01); });
    // In 2 s the clocks drift apart by a millisecond.
    EXPECT_NEAR(spread.least, kDelay + 0.01, 0.004) << drift;
    EXPECT_GT(spread.given, 0.9 * spread.sent) << drift;
  }
}

TEST(Playout, FollowsClocksThatDriftAlsoIfItWaitsForNone) {
  PlayoutSettings settings;
  settings.most = 0.0;
  for (const double drift : {-500e-6, 500e-6}) {
    Playout playout(settings);
    const Spread spread = run(playout, 60.0, drift, [] { return 0.0; });
    EXPECT_LT(spread.most, kDelay + 2.0 * kTick) << drift;
    EXPECT_EQ(spread.given, spread.sent) << drift;
  }
}

TEST(Playout, NeverWaitsLongerThanTheMost) {
  test::Random random(4);
  PlayoutSettings settings;
  settings.most = 0.03;
  Playout playout(settings);
  run(playout, 10.0, 0.0, [&] { return random.uniform(0.0, 0.2); });
  EXPECT_LE(playout.wait(), 0.03);
  EXPECT_GT(playout.jitter(), 0.15);
}

TEST(Playout, SlewsTheWait) {
  Playout playout;
  double lateness = 0.0, last_wait = 0.0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    if (n == 1000) lateness = 0.03;
    const double now = sent + kDelay + (n % 2 == 0 ? 0.0 : lateness);
    (void)playout.push(makeNumbered(n), sent, now);
    while (playout.pop(now, now + kTick)) {
    }
    if (n > 300) {
      EXPECT_LE(std::abs(playout.wait() - last_wait), 0.01 * 0.04 + 1e-12) << n;
    }
    last_wait = playout.wait();
  }
  EXPECT_NEAR(playout.wait(), 0.03, 1e-3);
}

// A site starts 1.3 s after its first packets. From then on the wait must not jump.
TEST(Playout, WaitSlewsFromTheStartOfASite) {
  PlayoutSettings settings;
  Playout playout(settings);
  double last = 0.0, most = 0.0;
  for (std::uint64_t n = 0; n < 512; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    const double jitter = sent < 1.4 ? 0.002 : 0.03;
    const double now = sent + kDelay + (n % 2 == 0 ? jitter : 0.0);
    (void)playout.push(makeNumbered(n), sent, now);
    while (playout.pop(now, now + kPeriod)) {
    }
    if (sent > 1.3) most = std::max(most, playout.wait() - last);
    last = playout.wait();
  }
  EXPECT_LT(most, settings.slew * 0.05);  // packets are at most 0.04 s apart
  EXPECT_GT(playout.wait(), 0.02);
}

TEST(Playout, OffAppliesAsItComes) {
  PlayoutSettings settings;
  settings.is_on = false;
  Playout playout(settings);
  test::Random random(5);
  for (std::uint64_t n = 0; n < 200; ++n) {
    const double sent = static_cast<double>(n) * kPeriod, now = sent + random.uniform(0.0, 0.007);
    (void)playout.push(makeNumbered(n), sent, now);
    const auto given = playout.pop(now, now + kTick);
    ASSERT_TRUE(given);
    EXPECT_EQ(given->time, now);
  }
  EXPECT_EQ(playout.wait(), 0.0);
  EXPECT_GT(playout.jitter(), 1e-3);
}

TEST(Playout, OvertakenPacketsAreStale) {
  Playout playout;
  (void)playout.push(makeNumbered(5), 0.05, 0.1);
  ASSERT_TRUE(playout.pop(0.1, 0.101));
  EXPECT_EQ(playout.push(makeNumbered(4), 0.04, 0.101), Playout::Verdict::kStale);
  EXPECT_EQ(playout.push(makeNumbered(5), 0.05, 0.101), Playout::Verdict::kStale);
  EXPECT_FALSE(playout.pop(0.2, 0.3));
  EXPECT_EQ(playout.counts().stale, 2u);
}

// A link holds packets for seconds and releases them all at once. None of it may be felt.
TEST(Playout, BurstAfterAnOutageIsRefused) {
  Playout playout;
  std::uint64_t n = 0;
  double now = 0.0;
  for (; now < 3.0; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    now = sent + kDelay;
    (void)playout.push(makeNumbered(n), sent, now);
    while (playout.pop(now, now + kTick)) {
    }
  }
  const double burst = now + 5.0;
  for (; static_cast<double>(n) * kPeriod + kDelay < burst; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    const bool is_old = burst - sent - kDelay > 0.5;
    EXPECT_EQ(playout.push(makeNumbered(n), sent, burst) == Playout::Verdict::kTooLate, is_old);
  }
  const auto given = playout.pop(burst, burst + kTick);
  ASSERT_TRUE(given);
  EXPECT_GT(static_cast<double>(given->packet.sequence) * kPeriod, burst - kDelay - 0.5 - 1e-9);
}

TEST(Playout, QueueThatRunsEmptySlowlyIsRefusedToo) {
  Playout playout;
  std::uint64_t n = 0;
  for (; n < 384; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    (void)playout.push(makeNumbered(n), sent, sent + kDelay);
  }
  // The link holds packets for 8 s, then releases them at twice the rate they were sent.
  const double start = static_cast<double>(n) * kPeriod + 8.0;
  for (const std::uint64_t first = n;; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    const double now = start + static_cast<double>(n - first) * kPeriod / 2.0;
    if (now - sent < kDelay + 0.5) break;
    EXPECT_EQ(playout.push(makeNumbered(n), sent, now), Playout::Verdict::kTooLate) << now - sent;
  }
}

TEST(Playout, LongerWayIsAcceptedAfterAWhile) {
  Playout playout;
  std::uint64_t n = 0;
  for (; n < 384; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    (void)playout.push(makeNumbered(n), sent, sent + kDelay);
  }
  int refused = 0;
  for (; n < 384 + 512; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    refused +=
        playout.push(makeNumbered(n), sent, sent + kDelay + 0.7) == Playout::Verdict::kTooLate;
  }
  EXPECT_NEAR(refused, 2.0 / kPeriod, 2.0);
}

/// One of 20 packets has no delay, all others have `delay`, for 20 s. Counts the gaps in playout
/// longer than three packet periods in the last 10 s.
int countGapsOfJumpers(double delay, std::uint64_t first_jumper, Spread& spread) {
  struct Arriving {
    double at;
    std::uint64_t n;
  };
  std::vector<Arriving> all;
  for (std::uint64_t n = 0; n < 2560; ++n)
    all.push_back({static_cast<double>(n) * kPeriod + (n % 20 == first_jumper ? 0.0 : delay), n});
  std::stable_sort(all.begin(), all.end(),
                   [](const Arriving& a, const Arriving& b) { return a.at < b.at; });
  Playout playout;
  int gaps = 0;
  double last = 10.0;
  auto next = all.begin();
  for (double now = 0.0; now < 20.0; now += kTick) {
    for (; next != all.end() && next->at <= now; ++next)
      (void)playout.push(makeNumbered(next->n), static_cast<double>(next->n) * kPeriod + kSkew,
                         now);
    while (const auto given = playout.pop(now, now + kTick)) {
      if (now < 10.0) continue;
      gaps += now - last > 3.0 * kPeriod;
      last = now;
      const double after = given->time - static_cast<double>(given->packet.sequence) * kPeriod;
      spread.least = std::min(spread.least, after);
      spread.most = std::max(spread.most, after);
    }
  }
  return gaps;
}

// Playing a state long before its time would make all earlier packets worthless.
TEST(Playout, PacketsThatJumpTheQueueWaitForTheirTurn) {
  for (const double delay : {0.03, 0.1, 0.3, 1.0}) {
    for (const std::uint64_t first : {0u, 7u}) {
      Spread spread;
      EXPECT_EQ(countGapsOfJumpers(delay, first, spread), 0) << delay << " " << first;
      EXPECT_GT(spread.least, delay - 1e-9) << delay << " " << first;
      EXPECT_LT(spread.most, delay + 2.0 * kTick) << delay << " " << first;
    }
  }
}

TEST(Playout, ShorterWayIsFollowedWithinASecond) {
  Playout playout;
  double now = 0.0, after = 0.0;
  for (std::uint64_t n = 0; n < 640; ++n) {
    const double sent = static_cast<double>(n) * kPeriod;
    const double arrival = sent + (n < 512 ? 0.3 : 0.05);
    for (; now < arrival; now += kTick)
      while (const auto given = playout.pop(now, now + kTick))
        after = given->time - static_cast<double>(given->packet.sequence) * kPeriod;
    (void)playout.push(makeNumbered(n), sent, std::max(arrival, now));
  }
  EXPECT_LT(after, 0.06);
}

TEST(Playout, FullKeepsTheNewest) {
  PlayoutSettings settings;
  settings.room = 2;
  Playout playout(settings);
  for (const std::uint64_t n : {1u, 2u, 3u}) (void)playout.push(makeNumbered(n), 0.0, 0.0);
  EXPECT_EQ(playout.push(makeNumbered(0), 0.0, 0.0), Playout::Verdict::kFull);
  EXPECT_EQ(playout.counts().full, 2u);
  EXPECT_EQ(playout.pop(0.0, 1.0)->packet.sequence, 2u);
  EXPECT_EQ(playout.pop(0.0, 1.0)->packet.sequence, 3u);
}

TEST(Playout, ClearForgetsTheSender) {
  Playout playout;
  (void)playout.push(makeNumbered(900), 50.0, 1.0);
  ASSERT_TRUE(playout.pop(1.0, 2.0));
  playout.clear();
  EXPECT_EQ(playout.push(makeNumbered(0), 0.0, 2.0), Playout::Verdict::kWaits);
  EXPECT_EQ(playout.pop(2.0, 2.1)->packet.sequence, 0u);
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Playout, RefusesBadSettingsByName) {
  const auto refusal = [](auto spoil) { return test::refusalOf(&checkPlayoutSettings, spoil); };
  EXPECT_NE(refusal([](auto& s) { s.most = -1.0; }).find("most"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.quantile = 1.5; }).find("quantile"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.slew = kNan; }).find("slew"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.max_late = 0.0; }).find("max_late"), std::string::npos);
  EXPECT_NE(refusal([](auto& s) { s.room = 0; }).find("room"), std::string::npos);
}

}  // namespace
}  // namespace tandem
