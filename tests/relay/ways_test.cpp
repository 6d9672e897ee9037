// The way between two sites: direct where one answers first, else by the relay; changes of it.

#include <gtest/gtest.h>

#include "relay/relayed_sites.h"

namespace tandem {
namespace {

using test::RelayedSites;

// States come each 7.8 ms; ticks of this network are 1 ms.
constexpr double kTwoPackets = 0.0176;  // [s]

bool areRelayed(RelayedSites& sites) {
  return sites.status(1, 2).is_relayed && sites.status(2, 1).is_relayed;
}
bool areDirect(RelayedSites& sites) {
  return !sites.status(1, 2).is_relayed && !sites.status(2, 1).is_relayed;
}

TEST(Ways, SitesMeetByTheRelayAlone) {
  RelayedSites sites(3, {.has_direct = false});
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(10.0);
  EXPECT_TRUE(areRelayed(sites));
  EXPECT_LT(sites.longestGapOver(5.0), kTwoPackets);
}

TEST(Ways, EightSitesLoseNoStateByTheRelay) {
  RelayedSites sites(8, {.has_direct = false});
  ASSERT_TRUE(sites.goLive(3.0));
  sites.run(1.0);
  for (RelayedSites::Site& site : sites.sites)
    for (auto& given : site.given) given.clear();
  sites.run(10.0);
  for (int at = 1; at <= 8; ++at) {
    for (int of = 1; of <= 8; ++of) {
      if (at == of) continue;
      EXPECT_NEAR(static_cast<double>(sites.at(at).given[static_cast<std::size_t>(of)].size()),
                  1250.0, 5.0);
      // Challenges on the direct way, which is not there, are no loss.
      EXPECT_EQ(sites.status(at, of).loss, 0.0);
    }
  }
}

TEST(Ways, TheDirectWayIsFoundAndTaken) {
  RelayedSites sites(2, {});
  ASSERT_TRUE(sites.goLive(2.0));
  EXPECT_LT(sites.longestGapOver(10.0), kTwoPackets);
  EXPECT_TRUE(areDirect(sites));
}

TEST(Ways, ASlowerDirectWayIsNotTaken) {
  RelayedSites sites(2, {.to_relay = 0.01, .direct = 0.03});
  ASSERT_TRUE(sites.goLive(2.0));
  EXPECT_LT(sites.longestGapOver(20.0), kTwoPackets);
  EXPECT_TRUE(areRelayed(sites));
  EXPECT_EQ(sites.status(1, 2).address_changes, 0u);
}

TEST(Ways, ADirectWayThatBecomesSlowIsLeftForTheRelay) {
  RelayedSites sites(2, {});
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(10.0);
  ASSERT_TRUE(areDirect(sites));
  sites.ways.direct = 0.05;
  sites.run(30.0);
  EXPECT_TRUE(areRelayed(sites));
}

// 18 against 20 ms: nobody gains by a change.
TEST(Ways, EqualWaysAreNotChangedBetween) {
  RelayedSites sites(2, {.to_relay = 0.009, .direct = 0.018, .loss = 0.02});
  ASSERT_TRUE(sites.goLive(5.0));
  sites.run(600.0);
  EXPECT_LE(sites.status(1, 2).address_changes, 1u);
  EXPECT_LE(sites.status(2, 1).address_changes, 1u);
}

TEST(Ways, ADirectWayThatFailsIsLeftBeforeGainsAreGone) {
  for (const bool fails_direct : {true, false}) {
    RelayedSites sites(2, {.direct = fails_direct ? 0.01 : 0.05});
    ASSERT_TRUE(sites.goLive(2.0));
    sites.run(10.0);
    ASSERT_EQ(areDirect(sites), fails_direct);
    (fails_direct ? sites.ways.has_direct : sites.ways.has_relay) = false;
    // Gains are gone after 250 ms.
    EXPECT_LT(sites.longestGapOver(10.0), 0.2) << fails_direct;
    EXPECT_EQ(areRelayed(sites), fails_direct);
  }
}

// TANDEM_WAY_SECONDS=3600 runs an hour.
TEST(Ways, ChangesOnceASecondMakeNoGap) {
  RelayedSites sites(2, {.to_relay = 0.008});
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(5.0);
  const auto changes = static_cast<int>(test::readCount("TANDEM_WAY_SECONDS", 300));
  for (int i = 0; i < changes; ++i) {
    sites.by_relay = i % 2 == 0;
    ASSERT_LT(sites.longestGapOver(1.0), kTwoPackets) << i;
  }
  EXPECT_EQ(sites.status(1, 2).states_too_late, 0u);
}

TEST(Ways, WithoutAnyWayThePeerFallsSilentAndComesBackByTheFirst) {
  RelayedSites sites(2, {});
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(10.0);
  sites.ways.has_relay = sites.ways.has_direct = false;
  sites.run(20.0);
  EXPECT_EQ(sites.status(1, 2).phase, PeerPhase::kCalling);
  sites.ways.has_relay = true;
  sites.run(6.0);
  EXPECT_LT(sites.longestGapOver(5.0), kTwoPackets);
  EXPECT_TRUE(areRelayed(sites));
}

}  // namespace
}  // namespace tandem
