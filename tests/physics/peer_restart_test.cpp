// A peer's program ends and another begins, on a link without sessions: its packets count from 0.

#include <deque>

#include <gtest/gtest.h>

#include "physics/reset_hosts.h"

namespace tandem {
namespace {

using test::ResetHosts;

constexpr double kOwnClock = 2.0;  // packets of a clock from 0 are late ones for so long [s]

/// With its own clock the peer's time begins at 0, too.
class PeerRestart : public ::testing::TestWithParam<bool> {
 protected:
  ResetHosts hosts{{.settle = 4.0, .has_one_clock = GetParam()}};
  double until_told = GetParam() ? 0.2 : kOwnClock + 0.2;  // [s]

  [[nodiscard]] const Site& first() const { return *hosts.scenes[0]->site; }
};

// It was lost for good: all its packets were stale.
TEST_P(PeerRestart, IsHeardAgain) {
  hosts.restart(1, 2.0);
  hosts.run(until_told);
  EXPECT_EQ(first().counters().peers_restarted, 1u);
  const std::uint64_t stale = first().counters().packets_stale;
  hosts.run(3.0);
  EXPECT_EQ(first().counters().packets_stale, stale);
  EXPECT_EQ(first().linkState(0), LinkState::kLive);
  for (int step = 0; step < 60; ++step) {
    hosts.scenes[1]->cube->activate(true);
    hosts.scenes[1]->cube->applyCentralForce(btVector3(2, 0, 0));
    hosts.run(1.0 / 60.0);
  }
  EXPECT_GT(hosts.at(0).x(), 0.01);
}

TEST_P(PeerRestart, GetsTheObjectsAsTheOthersHaveThem) {
  hosts.put(0, 3.0);
  hosts.run(1.0);
  hosts.restart(1, 2.0);
  EXPECT_LT(hosts.run(4.0), test::byWidth(1e-8, 1e-3));
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(hosts.at(i).x(), 3.0, test::byWidth(1e-8, 1e-5)) << i;
}

// It begins where the cube was at first. Its copy was pulled by a spring that nobody had stretched.
TEST_P(PeerRestart, IsLedToWhatWasPushedMeanwhile) {
  hosts.scenes[0]->cube->activate(true);
  hosts.scenes[0]->cube->setLinearVelocity(btVector3(10, 0, 0));
  hosts.run(2.0);
  hosts.restart(1, 2.0);
  ASSERT_GT(hosts.at(0).x(), 0.2);
  EXPECT_LT(hosts.run(6.0), 0.3);
  // Friction holds 0.29 N, a way of 5.9 mm of the spring of 50 N/m.
  EXPECT_NEAR(hosts.at(1).x(), hosts.at(0).x(), 6e-3);
}

TEST_P(PeerRestart, MayComeAgainAndAgain) {
  for (int n = 0; n < 3; ++n) {
    hosts.restart(1, 0.5);
    hosts.run(until_told + 1.0);
    EXPECT_EQ(first().counters().peers_restarted, n + 1u);
    EXPECT_EQ(first().linkState(0), LinkState::kLive);
  }
}

INSTANTIATE_TEST_SUITE_P(Clocks, PeerRestart, ::testing::Bool());

// 1.9 s of old packets come by a slow way when the new ones have stopped: nothing of it is felt.
TEST(PeerRestart, LatePacketsAreNone) {
  ResetHosts hosts({.settle = 3.0});
  auto& arrivals = hosts.links[0][1]->arrivals;
  std::deque<Arrival> late;
  for (int step = 0; step < 114; ++step) {
    hosts.run(1.0 / 60.0);
    for (const Arrival& arrival : arrivals) late.push_back({arrival.packet, arrival.time + 2.1});
    arrivals.clear();
  }
  hosts.run(0.1);  // the newest ones
  const Vec3 before_W = hosts.at(0);
  hosts.scenes[1].reset();
  arrivals.insert(arrivals.end(), late.begin(), late.end());
  const std::uint64_t stale = hosts.counters(0).packets_stale;
  hosts.run(3.0);
  EXPECT_GT(hosts.counters(0).packets_stale, stale + 20);
  EXPECT_EQ(hosts.counters(0).peers_restarted, 0u);
  EXPECT_EQ(hosts.scenes[0]->site->linkState(0), LinkState::kLost);
  EXPECT_EQ(hosts.at(0), before_W);
}

}  // namespace
}  // namespace tandem
