// computeFate() and computeCorruptBit(), which all network emulations share.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/impairments.h"
#include "tandem/coordination/simulated_link.h"

#include "link/packet_fates.h"

namespace tandem {
namespace {

constexpr std::uint64_t kCount = 20000;  // packets
constexpr std::uint64_t kSeeds[] = {0, 1, 7, 12345, ~std::uint64_t{0}};

TEST(PacketFate, SimulatedLinkGivesEachPacketItsFate) {
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Impairments impairments{0.1, 0.04, 0.2, 0.3, 0.1, seed};
    const auto [a, b] = makeSimulatedLinks(impairments);
    for (const Direction direction : {Direction::kForward, Direction::kBack}) {
      const bool is_forward = direction == Direction::kForward;
      const std::vector<Fate> seen =
          is_forward ? observeFates(*a, *b, kCount) : observeFates(*b, *a, kCount);
      for (std::uint64_t n = 0; n < kCount; ++n) {
        const PacketFate fate = computeFate(impairments, direction, n);
        const double now = static_cast<double>(n);
        Fate expected;  // the very same sums, so exactly equal
        if (!fate.is_lost) expected.push_back(std::max(now + fate.delay, now + kEarliest));
        if (!fate.is_lost && fate.is_duplicated) expected.push_back(now + fate.duplicate_delay);
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(seen[n], expected) << "packet " << n;
      }
    }
  }
}

TEST(PacketFate, SwitchingOneImpairmentOnShiftsNoOther) {
  const Impairments loss_alone{0.0, 0.0, 0.1, 0.0, 0.0, 7};
  const Impairments all{0.05, 0.01, 0.1, 0.2, 0.3, 7};
  for (std::uint64_t n = 0; n < kCount; ++n)
    ASSERT_EQ(computeFate(loss_alone, Direction::kForward, n).is_lost,
              computeFate(all, Direction::kForward, n).is_lost);
}

// The meaning of a seed must stay the same for users who wrote one down.
TEST(PacketFate, SeedSevenLosesThesePackets) {
  const Impairments impairments{0.0, 0.0, 0.02, 0.0, 0.0, 7};
  std::vector<std::uint64_t> forward, back;
  for (std::uint64_t n = 0; n < 300; ++n) {
    if (computeFate(impairments, Direction::kForward, n).is_lost) forward.push_back(n);
    if (computeFate(impairments, Direction::kBack, n).is_lost) back.push_back(n);
  }
  EXPECT_EQ(forward, (std::vector<std::uint64_t>{90, 93, 171, 223, 263, 272, 286}));
  EXPECT_EQ(back, (std::vector<std::uint64_t>{54, 96, 98, 118, 122, 187, 280, 284}));
}

TEST(PacketFate, RefusesImpairmentsOutOfRange) {
  EXPECT_NO_THROW(checkImpairments({1.0, 2.0, 1.0, 1.0, 1.0, 0}));
  EXPECT_THROW(checkImpairments({-0.1}), std::invalid_argument);
  EXPECT_THROW(checkImpairments({0.0, NAN}), std::invalid_argument);
  EXPECT_THROW(checkImpairments({0.0, 0.0, 1.1}), std::invalid_argument);
  EXPECT_THROW(checkImpairments({0.0, 0.0, 0.0, -0.1}), std::invalid_argument);
  EXPECT_THROW(checkImpairments({0.0, 0.0, 0.0, 0.0, NAN}), std::invalid_argument);
}

TEST(CorruptBit, IsOfTheRateAskedForAndEvenOverAllBits) {
  constexpr std::size_t kSize = 16;  // bytes
  for (const std::uint64_t seed : kSeeds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::vector<double> hits(8 * kSize, 0.0);
    double corrupted = 0.0;
    for (std::uint64_t n = 0; n < kCount; ++n)
      if (const auto bit =
              computeCorruptBit(0.5, seed, Direction::kForward, n, Copy::kFirst, kSize)) {
        hits.at(*bit) += 1.0;
        corrupted += 1.0;
      }
    const double count = static_cast<double>(kCount);
    EXPECT_NEAR(corrupted, 0.5 * count, 5.0 * std::sqrt(0.25 * count));
    // Chi-square with 127 degrees of freedom has mean 127 and deviation 16. It is above 5
    // deviations about once in 200000 times.
    const double each = corrupted / static_cast<double>(hits.size());
    double chi_square = 0.0;
    for (const double hit : hits) chi_square += (hit - each) * (hit - each) / each;
    EXPECT_LT(chi_square, 127.0 + 5.0 * std::sqrt(2.0 * 127.0));
  }
}

TEST(CorruptBit, OfCopiesAndDirectionsIsIndependent) {
  double both_copies = 0.0, both_ways = 0.0;
  for (std::uint64_t n = 0; n < kCount; ++n) {
    const bool first =
        computeCorruptBit(0.5, 3, Direction::kForward, n, Copy::kFirst, 8).has_value();
    const bool second =
        computeCorruptBit(0.5, 3, Direction::kForward, n, Copy::kDuplicate, 8).has_value();
    const bool back = computeCorruptBit(0.5, 3, Direction::kBack, n, Copy::kFirst, 8).has_value();
    both_copies += first && second ? 1.0 : 0.0;
    both_ways += first && back ? 1.0 : 0.0;
  }
  const double count = static_cast<double>(kCount);
  const double deviation = std::sqrt(count * 0.25 * 0.75);
  EXPECT_NEAR(both_copies, 0.25 * count, 5.0 * deviation);
  EXPECT_NEAR(both_ways, 0.25 * count, 5.0 * deviation);
}

TEST(CorruptBit, LeavesADatagramWithoutBytesAlone) {
  EXPECT_FALSE(computeCorruptBit(1.0, 0, Direction::kForward, 0, Copy::kFirst, 0));
  EXPECT_LT(*computeCorruptBit(1.0, 0, Direction::kForward, 0, Copy::kFirst, 1), 8U);
  EXPECT_FALSE(computeCorruptBit(0.0, 0, Direction::kForward, 0, Copy::kFirst, 1));
}

}  // namespace
}  // namespace tandem
