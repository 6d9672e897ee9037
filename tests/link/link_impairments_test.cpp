#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "link/packet_fates.h"

namespace tandem {
namespace {

constexpr std::uint64_t kCount = 20000;  // packets
constexpr std::uint64_t kSeeds[] = {0, 1, 2, 12345, ~std::uint64_t{0}};

/// Expects `observed` of `count` within 5 standard deviations for an event of that probability. A
/// correct generator fails once in two million times.
void expectRate(std::uint64_t observed, std::uint64_t count, double probability) {
  const double n = static_cast<double>(count);
  const double deviation = std::sqrt(n * probability * (1.0 - probability));
  EXPECT_NEAR(static_cast<double>(observed), n * probability, 5.0 * deviation);
}

std::uint64_t countIf(const std::vector<Fate>& fates, bool (*holds)(const Fate&)) {
  return static_cast<std::uint64_t>(std::count_if(fates.begin(), fates.end(), holds));
}

bool isLost(const Fate& fate) { return fate.empty(); }
bool isDoubled(const Fate& fate) { return fate.size() == 2; }

TEST(LinkImpairments, RatesAreThoseAskedFor) {
  for (const std::uint64_t seed : kSeeds) {
    for (const double p : {0.0, 0.001, 0.1, 0.5, 1.0}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", probability " + std::to_string(p));
      const Impairments impairments{0.1, 0.0, p, p, p, seed};
      const auto [a, b] = makeSimulatedLinks(impairments);
      const std::vector<Fate> fates = observeFates(*a, *b, kCount);
      const ChannelCounts& counts = a->counts();
      expectRate(counts.lost, kCount, p);
      expectRate(counts.duplicated, kCount - counts.lost, p);
      expectRate(counts.reordered, kCount - counts.lost, p);

      EXPECT_EQ(counts.sent, kCount);
      EXPECT_EQ(countIf(fates, isLost), counts.lost);
      EXPECT_EQ(countIf(fates, isDoubled), counts.duplicated);
      EXPECT_EQ(counts.delivered, kCount - counts.lost + counts.duplicated);
      EXPECT_EQ(counts.overflowed, 0U);
    }
  }
}

TEST(LinkImpairments, LossesDoNotComeInBursts) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Impairments impairments;
    impairments.loss = 0.3;
    impairments.seed = seed;
    const std::vector<Fate> fates = observeFates(impairments, kCount);
    for (const std::uint64_t apart : {1U, 2U, 7U, 128U}) {
      std::uint64_t both = 0;
      for (std::uint64_t n = apart; n < kCount; ++n)
        if (isLost(fates[n]) && isLost(fates[n - apart])) ++both;
      expectRate(both, kCount - apart, 0.09);
    }
  }
}

// Kolmogorov-Smirnov: the largest distance of the distributions, times sqrt(n). It is above 2.23
// once in ten thousand times.
TEST(LinkImpairments, JitterIsEvenInItsRange) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Fate> fates = observeFates({0.05, 0.02, 0.0, 0.0, 0.0, seed}, kCount);
    std::vector<double> evenly;  // uniform in [0, 1] if the delay is in 0.05 +- 0.02 s
    for (std::uint64_t n = 0; n < kCount; ++n)
      evenly.push_back((fates[n].at(0) - static_cast<double>(n) - 0.03) / 0.04);
    std::sort(evenly.begin(), evenly.end());

    EXPECT_GE(evenly.front(), -1e-9);  // rounding of times up to 20000 s over 0.04 s
    EXPECT_LE(evenly.back(), 1.0 + 1e-9);
    double distance = 0.0;
    for (std::uint64_t i = 0; i < kCount; ++i) {
      const double below = static_cast<double>(i) / kCount,
                   upTo = (static_cast<double>(i) + 1.0) / kCount;
      distance = std::max({distance, evenly[i] - below, upTo - evenly[i]});
    }
    EXPECT_LT(distance * std::sqrt(static_cast<double>(kCount)), 2.23);
  }
}

TEST(LinkImpairments, JitterNeverMakesAPacketArriveBeforeItWasSent) {
  const std::vector<Fate> fates = observeFates({0.01, 0.05, 0.0, 0.0, 0.0, 3}, kCount);
  std::uint64_t at_once = 0;
  for (std::uint64_t n = 0; n < kCount; ++n)
    if (fates[n].at(0) == static_cast<double>(n) + kEarliest) ++at_once;
  // The part of -0.04 .. 0.06 s that is below kEarliest.
  expectRate(at_once, kCount, (0.04 + kEarliest) / 0.1);
}

TEST(LinkImpairments, EachCopyHasItsOwnJitter) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Fate> fates = observeFates({0.1, 0.1, 0.0, 1.0, 0.0, seed}, kCount);
    std::uint64_t both_early = 0;
    for (std::uint64_t n = 0; n < kCount; ++n) {
      ASSERT_TRUE(isDoubled(fates[n]));
      EXPECT_LT(fates[n][0], fates[n][1]);
      if (fates[n][1] < static_cast<double>(n) + 0.06) ++both_early;  // 3 tenths of 0.1 +- 0.1 s
    }
    expectRate(both_early, kCount, 0.09);
  }
}

TEST(LinkImpairments, DirectionsAreIndependent) {
  const Impairments impairments{0.05, 0.02, 0.5, 0.0, 0.0, 5};
  const auto [a, b] = makeSimulatedLinks(impairments);
  const std::vector<Fate> there = observeFates(*a, *b, kCount);
  const std::vector<Fate> back = observeFates(*b, *a, kCount);
  std::uint64_t both_lost = 0, equal_delays = 0;
  for (std::uint64_t n = 0; n < kCount; ++n) {
    if (isLost(there[n]) && isLost(back[n])) ++both_lost;
    if (!isLost(there[n]) && there[n] == back[n]) ++equal_delays;
  }
  expectRate(both_lost, kCount, 0.25);
  EXPECT_EQ(equal_delays, 0U);

  // Traffic on the forward way does not affect the way back.
  const auto [c, d] = makeSimulatedLinks(impairments);
  EXPECT_EQ(observeFates(*d, *c, kCount), back);
}

TEST(LinkImpairments, EqualSeedsGiveEqualFatesAndOthersDoNot) {
  Impairments impairments{0.05, 0.02, 0.1, 0.1, 0.1, 1};
  const std::vector<Fate> fates = observeFates(impairments, 1000);
  EXPECT_EQ(observeFates(impairments, 1000), fates);
  for (const std::uint64_t seed : {0U, 2U, 3U}) {
    impairments.seed = seed;
    EXPECT_NE(observeFates(impairments, 1000), fates) << seed;
  }
}

// Loss depends neither on the packets' contents nor on their times.
TEST(LinkImpairments, FateDependsOnThePacketsNumberOnly) {
  Impairments impairments;
  impairments.loss = 0.3;
  const std::vector<Fate> fates = observeFates(impairments, 1000);
  const auto [a, b] = makeSimulatedLinks(impairments, 1000);
  for (std::uint64_t n = 0; n < 1000; ++n) {
    StatePacket packet = makePacket(5 * n + 3);
    packet.time = 77.0;
    a->send(packet, 0.0);
  }
  std::vector<std::uint64_t> arrived, expected;
  for (const Arrival& arrival : receiveAll(*b, 1.0, 2.0))
    arrived.push_back(arrival.packet.sequence);
  for (std::uint64_t n = 0; n < 1000; ++n)
    if (!isLost(fates[n])) expected.push_back(5 * n + 3);
  EXPECT_EQ(arrived, expected);
}

TEST(LinkImpairments, MoreLossTakesMoreButGivesNothingBack) {
  Impairments impairments;
  std::vector<Fate> fates = observeFates(impairments, 1000);
  for (const double loss : {0.01, 0.1, 0.3, 0.9}) {
    impairments.loss = loss;
    const std::vector<Fate> worse = observeFates(impairments, 1000);
    for (std::uint64_t n = 0; n < 1000; ++n)
      EXPECT_TRUE(!isLost(fates[n]) || isLost(worse[n])) << n;
    EXPECT_GT(countIf(worse, isLost), countIf(fates, isLost));
    fates = worse;
  }
}

/// Effect of each impairment on each packet when it acts alone. This predicts any combination.
class Foretold {
 public:
  Foretold(const Impairments& all, std::uint64_t count) : all_(all) {
    const double delay = all.delay;
    lost_ = observeFates({delay, 0.0, all.loss, 0.0, 0.0, all.seed}, count);
    doubled_ = observeFates({delay, 0.0, 0.0, all.duplicate, 0.0, all.seed}, count);
    jumps_ = observeFates({delay, 0.0, 0.0, 0.0, all.reorder, all.seed}, count);
    jittered_ = observeFates({delay, all.jitter, 0.0, 0.0, 0.0, all.seed}, count);
    both_jittered_ = observeFates({delay, all.jitter, 0.0, 1.0, 0.0, all.seed}, count);
  }

  /// Fate of packet n under the impairments that are not 0.
  Fate foretell(std::uint64_t n, const Impairments& active) const {
    if (active.loss > 0.0 && isLost(lost_[n])) return {};
    const double sent = static_cast<double>(n);
    const double jittered = jittered_[n].at(0);
    Fate fate = {active.jitter > 0.0 ? jittered : sent + all_.delay};
    if (active.reorder > 0.0 && jumps_[n].at(0) == sent + kEarliest) fate[0] = sent + kEarliest;
    if (active.duplicate > 0.0 && isDoubled(doubled_[n])) {
      const Fate& both = both_jittered_[n];
      const double copy = both.at(0) == jittered ? both.at(1) : both.at(0);
      fate.push_back(active.jitter > 0.0 ? copy : sent + all_.delay);
    }
    std::sort(fate.begin(), fate.end());
    return fate;
  }

 private:
  Impairments all_;
  std::vector<Fate> lost_, doubled_, jumps_, jittered_, both_jittered_;
};

// All 16 combinations, packet by packet and exactly: switching one impairment on does not affect
// the others.
TEST(LinkImpairments, SwitchingOneOnShiftsNoOther) {
  constexpr std::uint64_t kPackets = 2000;
  for (const std::uint64_t seed : kSeeds) {
    const Impairments all{0.3, 0.1, 0.2, 0.3, 0.25, seed};
    const Foretold foretold(all, kPackets);
    for (unsigned on = 0; on < 16; ++on) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", combination " + std::to_string(on));
      Impairments active = all;
      if ((on & 1U) == 0) active.jitter = 0.0;
      if ((on & 2U) == 0) active.loss = 0.0;
      if ((on & 4U) == 0) active.duplicate = 0.0;
      if ((on & 8U) == 0) active.reorder = 0.0;
      const std::vector<Fate> fates = observeFates(active, kPackets);
      for (std::uint64_t n = 0; n < kPackets; ++n)
        ASSERT_EQ(fates[n], foretold.foretell(n, active)) << "packet " << n;
    }
  }
}

// Loss is independent of all other decisions about a packet.
TEST(LinkImpairments, DecisionsAreNotCorrelated) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const std::vector<Fate> lost = observeFates({0.1, 0.0, 0.3, 0.0, 0.0, seed}, kCount);
    const std::vector<Fate> doubled = observeFates({0.1, 0.0, 0.0, 0.3, 0.0, seed}, kCount);
    const std::vector<Fate> jumping = observeFates({0.1, 0.0, 0.0, 0.0, 0.3, seed}, kCount);
    const std::vector<Fate> jittered = observeFates({0.1, 0.1, 0.0, 0.0, 0.0, seed}, kCount);
    std::uint64_t pairs[6] = {};
    for (std::uint64_t n = 0; n < kCount; ++n) {
      const double sent = static_cast<double>(n);
      const bool is_lost = isLost(lost[n]), is_doubled = isDoubled(doubled[n]);
      const bool jumps = jumping[n].at(0) == sent + kEarliest;
      const bool is_early = jittered[n].at(0) < sent + 0.06;  // 3 tenths of 0.1 +- 0.1 s
      pairs[0] += is_lost && is_doubled;
      pairs[1] += is_lost && jumps;
      pairs[2] += is_lost && is_early;
      pairs[3] += is_doubled && jumps;
      pairs[4] += is_doubled && is_early;
      pairs[5] += jumps && is_early;
    }
    for (const std::uint64_t both : pairs) expectRate(both, kCount, 0.09);
  }
}

}  // namespace
}  // namespace tandem
