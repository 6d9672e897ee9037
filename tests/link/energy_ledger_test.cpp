// Private header of coordination: how energy moves between the accounts of two sites.
#include "coordination/src/link/energy_ledger.h"

#include <deque>
#include <vector>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double kTank = 0.02;

/// Two accounts and the reports between them.
struct Pair {
  double held[2] = {kTank, kTank};
  EnergyLedger ledger[2];

  EnergyReport report(int from) {
    held[from] -= ledger[from].grant(held[from], kTank, 2);
    return ledger[from].report(held[from]);
  }
  void hear(int to, const EnergyReport& report) { held[to] += ledger[to].hear(report); }
  void exchange() {
    for (const int from : {0, 1}) hear(1 - from, report(from));
  }
};

TEST(EnergyLedger, EvensOutWhatBothHold) {
  Pair pair;
  pair.exchange();
  pair.held[0] += 1.0;
  for (int i = 0; i < 3; ++i) pair.exchange();
  EXPECT_NEAR(pair.held[0], kTank + 0.5, 1e-8);
  EXPECT_NEAR(pair.held[1], kTank + 0.5, 1e-8);
  EXPECT_EQ(pair.held[0] + pair.held[1], 2.0 * kTank + 1.0);
}

TEST(EnergyLedger, NobodyGivesAwayTheTank) {
  Pair pair;
  pair.exchange();
  pair.held[1] -= 50.0;
  for (int i = 0; i < 5; ++i) pair.exchange();
  EXPECT_EQ(pair.held[0], kTank);
}

TEST(EnergyLedger, GrantsNothingBeforeItHearsThePeer) {
  EnergyLedger ledger;
  EXPECT_EQ(ledger.grant(5.0, kTank, 2), 0.0);
  EXPECT_EQ(ledger.hear({3.0, -5.0}), 0.0);
  EXPECT_GT(ledger.grant(5.0, kTank, 2), 0.0);
}

// Late, lost and repeated reports make no energy, and in the end lose none.
TEST(EnergyLedger, KeepsTheSumOnABadNetwork) {
  constexpr std::uint64_t kSeed = 43;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int round = 0; round < 50; ++round) {
    Pair pair;
    pair.exchange();
    double put_in = 0.0;
    std::deque<EnergyReport> way[2];
    std::vector<EnergyReport> newest(2);
    for (int step = 0; step < 2000; ++step) {
      const int hand = random.below(2);
      const double work = random.uniform(-0.01, 0.011);
      if (pair.held[hand] + work > 0.0) {
        pair.held[hand] += work;
        put_in += work;
      }
      for (const int from : {0, 1}) {
        newest[static_cast<std::size_t>(from)] = pair.report(from);
        way[from].push_back(newest[static_cast<std::size_t>(from)]);
        if (random.below(3) == 0) way[from].pop_back();  // lost
        if (way[from].size() < 20) continue;
        pair.hear(1 - from, way[from].front());
        if (random.below(3) > 0) way[from].pop_front();  // else it comes again
      }
      // Energy on its way is at neither side.
      ASSERT_LE(pair.held[0] + pair.held[1], 2.0 * kTank + put_in + 1e-9);
    }
    for (const int from : {0, 1}) pair.hear(1 - from, newest[static_cast<std::size_t>(from)]);
    EXPECT_NEAR(pair.held[0] + pair.held[1], 2.0 * kTank + put_in, 1e-9);
  }
}

}  // namespace
}  // namespace tandem
