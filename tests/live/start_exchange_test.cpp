// Sites with unrelated clocks agree on one moment, in virtual time.

#include "live/start_exchange.h"

#include <memory>

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "live/shifted_link.h"

namespace tandem {
namespace {

using test::ShiftedLink;

constexpr double kPoll = 1e-3;         // [s]
constexpr double kPacketRate = 128.0;  // [1/s]
const PointState kHeld{{0.1, 0.2, 0.3}, Vec3::Zero()};

/// All sites of a room; a simulated link connects each pair.
class Sites {
 public:
  struct Site {
    double ahead;  ///< its clock minus true time [s]
    std::vector<std::unique_ptr<ShiftedLink>> ways;
    std::vector<std::unique_ptr<TimeBridge>> bridges;
    std::vector<PeerId> ids;  ///< of the peers that the bridges lead to
    std::unique_ptr<StartExchange> exchange;
    bool is_there = true;
  };

  Sites(int count, const Impairments& network) : round_trip_(2.0 * network.delay) {
    for (int i = 0; i < count; ++i) {
      sites_.push_back({1000.0 * i, {}, {}, {}, nullptr});
      begin(i);
    }
    for (int i = 0; i < count; ++i)
      for (int k = i + 1; k < count; ++k) connect(i, k, network);
  }

  void begin(int i) {
    at(i).exchange = std::make_unique<StartExchange>(idOf(i), kHeld, kPacketRate);
    for (const auto& bridge : at(i).bridges) bridge->awaitStart();
  }

  void run(double seconds) {
    for (const double end = now + seconds; now < end; now += kPoll)
      for (Site& site : sites_)
        if (site.is_there) poll(site);
  }

  [[nodiscard]] Site& at(int i) { return sites_[static_cast<std::size_t>(i)]; }
  /// Start of site `i` in true time.
  [[nodiscard]] std::optional<double> startOf(int i) {
    const auto start = at(i).exchange->start();
    if (!start) return std::nullopt;
    return *start - at(i).ahead;
  }

  double now = 0.0;  ///< true time [s]

 private:
  void connect(int i, int k, const Impairments& network) {
    auto ends = makeSimulatedLinks(network);
    links_.push_back(std::move(ends.first));
    add(at(i), idOf(k), *links_.back());
    links_.push_back(std::move(ends.second));
    add(at(k), idOf(i), *links_.back());
  }
  static PeerId idOf(int i) { return PeerId{static_cast<std::uint32_t>(i + 1)}; }
  void add(Site& site, PeerId peer, Link& link) {
    site.ids.push_back(peer);
    site.ways.push_back(std::make_unique<ShiftedLink>(link, site.ahead));
    site.bridges.push_back(std::make_unique<TimeBridge>(*site.ways.back()));
    site.bridges.back()->awaitStart();
  }
  void poll(Site& site) {
    std::vector<StartExchange::Peer> peers;
    for (std::size_t i = 0; i < site.bridges.size(); ++i) {
      site.bridges[i]->setClock(now + site.ahead);
      peers.push_back({site.ids[i], *site.bridges[i], true, round_trip_, 0.0});
    }
    site.exchange->advance(now + site.ahead, peers);
  }

  double round_trip_;
  std::vector<std::unique_ptr<SimulatedLink>> links_;
  std::vector<Site> sites_;
};

TEST(StartExchange, BothSitesBeginAtOneMoment) {
  Sites sites(2, {.delay = 0.05});
  sites.run(0.3);
  EXPECT_FALSE(sites.startOf(0)) << "the round trip may not be right yet";
  sites.run(0.2);
  ASSERT_TRUE(sites.startOf(0));
  ASSERT_TRUE(sites.startOf(1));
  EXPECT_GT(*sites.startOf(0), 1.3);
  EXPECT_NEAR(*sites.startOf(1), *sites.startOf(0), kPoll);
}

TEST(StartExchange, ALongWayHasALongCountdown) {
  Sites sites(2, {.delay = 0.4});
  sites.run(1.5);
  ASSERT_TRUE(sites.startOf(1));
  EXPECT_GT(*sites.startOf(1), 0.3 + 6.0 * 0.8);
  EXPECT_NEAR(*sites.startOf(1), *sites.startOf(0), kPoll);
}

TEST(StartExchange, SurvivesLoss) {
  Sites sites(2, {.delay = 0.02, .loss = 0.5, .seed = 3});
  sites.run(0.6);
  ASSERT_TRUE(sites.startOf(1));
  EXPECT_NEAR(*sites.startOf(1), *sites.startOf(0), kPoll);
}

TEST(StartExchange, ThreeSitesBeginAtOneMoment) {
  Sites sites(3, {.delay = 0.03});
  sites.run(0.5);
  for (const int i : {1, 2}) {
    ASSERT_TRUE(sites.startOf(i));
    EXPECT_NEAR(*sites.startOf(i), *sites.startOf(0), kPoll);
  }
}

TEST(StartExchange, OnlyTheLowestNumberChooses) {
  Sites sites(2, {.delay = 0.01});
  sites.at(0).is_there = false;
  sites.run(5.0);
  EXPECT_FALSE(sites.startOf(1));
}

TEST(StartExchange, WaitsUntilAllPeersAreLive) {
  PeerId self{1};
  auto ends = makeSimulatedLinks({});
  TimeBridge bridge(*ends.first);
  bridge.awaitStart();
  StartExchange exchange(self, kHeld, kPacketRate);
  const auto poll = [&](double from, double until, bool is_live, double round_trip) {
    for (double now = from; now < until; now += kPoll) {
      bridge.setClock(now);
      exchange.advance(now, {{PeerId{2}, bridge, is_live, round_trip, 0.0}});
    }
    return exchange.start().has_value();
  };
  EXPECT_FALSE(poll(0.0, 1.0, false, 0.02));
  EXPECT_FALSE(poll(1.0, 2.0, true, 0.0)) << "the round trip is not known";
  EXPECT_FALSE(poll(2.0, 2.2, true, 0.02));
  EXPECT_FALSE(poll(2.2, 2.3, false, 0.02));
  EXPECT_FALSE(poll(2.3, 2.5, true, 0.02)) << "it was not live all the time";
  EXPECT_TRUE(poll(2.5, 2.7, true, 0.02));
}

// A site that restarts learns when the others began.
TEST(StartExchange, ALateSiteLearnsAStartThatHasPassed) {
  Sites sites(2, {.delay = 0.02});
  sites.run(3.0);
  const double start = *sites.startOf(1);
  ASSERT_LT(start, sites.now);
  sites.begin(0);
  sites.run(0.2);
  ASSERT_TRUE(sites.startOf(0));
  EXPECT_NEAR(*sites.startOf(0), start, 2.0 * kPoll);
}

/// Site `self` hears a peer whose states carry this time; it is polled for 50 ms.
class Listening {
 public:
  Listening(PeerId self, PeerId peer, double time, double longest = kLongestCountdown)
      : ends_(makeSimulatedLinks({})),
        bridge_(*ends_.first),
        exchange(self, kHeld, 128.0, longest) {
    bridge_.awaitStart();
    StatePacket packet;
    packet.sender = peer;
    packet.time = time;
    ends_.second->send(packet, 0.0);
    for (double now = 0.0; now < 0.05; now += kPoll) {
      bridge_.setClock(now);
      exchange.advance(now, {{peer, bridge_, true, 0.02, 0.0}});
    }
  }

 private:
  std::pair<std::unique_ptr<SimulatedLink>, std::unique_ptr<SimulatedLink>> ends_;
  TimeBridge bridge_;

 public:
  StartExchange exchange;
};

// A peer whose site time began at 0 held the other one in a countdown of 976 s.
TEST(StartExchange, ACountdownThatIsTooLongIsRefused) {
  for (const auto& [time, longest] : {std::pair{24.0, 60.0}, {939.9, 60.0}, {994.0, 5.0}}) {
    SCOPED_TRACE(time);
    const Listening two(PeerId{2}, PeerId{1}, time, longest);
    EXPECT_FALSE(two.exchange.start());
    ASSERT_TRUE(two.exchange.refused());
    EXPECT_EQ(two.exchange.refused()->peer, PeerId{1});
    EXPECT_NEAR(two.exchange.refused()->length, 1000.0 - time, 1e-9);
  }
  EXPECT_TRUE(Listening(PeerId{2}, PeerId{1}, 940.1).exchange.start());
  EXPECT_FALSE(Listening(PeerId{2}, PeerId{1}, 0.0).exchange.refused());
}

TEST(StartExchange, TheLowerSiteFollowsNoCountdown) {
  const Listening one(PeerId{1}, PeerId{2}, 990.0);
  EXPECT_FALSE(one.exchange.start());
  EXPECT_FALSE(one.exchange.refused());
  // It joins any peer that runs already.
  EXPECT_TRUE(Listening(PeerId{1}, PeerId{2}, 1000.5).exchange.start());
}

TEST(StartExchange, HeldStatesComeAtTheirRate) {
  Sites sites(2, {.delay = 0.02});
  sites.run(2.0);
  EXPECT_NEAR(static_cast<double>(sites.at(0).ways[0]->stamps.size()), 2.0 * kPacketRate, 20.0);
}

}  // namespace
}  // namespace tandem
