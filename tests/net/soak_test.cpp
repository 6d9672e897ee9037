// Long runs on bad networks: scripts/soak.sh lets these run for hours of virtual time.

#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "net/virtual_net.h"

namespace tandem {
namespace {

using test::readCount;
using test::VirtualSites;

TEST(Soak, FourPeersOnABadNetwork) {
  constexpr std::uint64_t kSeed = 20090404;
  SCOPED_TRACE(kSeed);
  const std::uint64_t minutes = readCount("TANDEM_SOAK_MINUTES", 10);
  VirtualSites sites(4, {1.0, 0.1, 0.25, 0.25, 0.0}, kSeed);
  ASSERT_TRUE(sites.goLive(120.0));
  for (std::uint64_t minute = 0; minute < minutes; ++minute) {
    SCOPED_TRACE(minute);
    sites.forgetGiven();
    const std::uint16_t epoch = sites.status(1, 2).key_epoch;
    sites.run(60.0);
    // Keys are renewed every 120 s and not more often, also where the count wraps round.
    ASSERT_LE(static_cast<std::uint16_t>(sites.status(1, 2).key_epoch - epoch), 2);
    for (int id = 1; id <= 4; ++id) {
      for (int other = 1; other <= 4; ++other) {
        if (id == other) continue;
        const auto& given = sites.at(id).given[static_cast<std::size_t>(other)];
        // 7500 are sent a minute and three quarters arrive. Most of these are not overtaken in 100
        // ms of jitter.
        ASSERT_GT(given.size(), 3500u) << id << " of " << other;
        double last = 0.0;
        for (const Arrival& arrival : given) {
          ASSERT_GT(arrival.packet.time, last);
          last = arrival.packet.time;
          ASSERT_LT(arrival.time - arrival.packet.time, 1.0 + 0.1 + 0.05 + 0.5);
        }
        ASSERT_EQ(sites.status(id, other).phase, PeerPhase::kLive);
      }
      ASSERT_EQ(sites.at(id).mesh->counts().of(net::Refusal::kForged), 0u);
    }
  }
}

// Sites come, go, are killed and change their addresses. No nonce is ever used twice under one key,
// and within seconds after it all are live.
TEST(Soak, SitesComeAndGo) {
  constexpr std::uint64_t kSeed = 20090405;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  VirtualSites sites(2, {0.02, 0.01, 0.05, 0.05, 0.0}, kSeed);
  // Session, epoch, sequence and sender: a session's number is drawn anew with its keys.
  std::set<std::array<std::uint8_t, 16>> nonces;
  sites.net.tap = [&](const auto& bytes, const auto&, const auto&) {
    if (bytes[3] < static_cast<std::uint8_t>(MessageType::kState)) return;
    std::array<std::uint8_t, 16> nonce;
    std::copy_n(bytes.begin() + 4, nonce.size(), nonce.begin());
    ASSERT_TRUE(nonces.insert(nonce).second);
  };
  const std::uint64_t cycles = readCount("TANDEM_CHURN_CYCLES", 200);
  for (std::uint64_t cycle = 0; cycle < cycles; ++cycle) {
    SCOPED_TRACE(cycle);
    const int who = 1 + random.below(2);
    switch (random.below(4)) {
      case 0:  // leaves and joins again
        sites.at(who).mesh->leave(ByeReason::kUserLeaves, sites.clock());
        sites.run(random.uniform(0.0, 0.3));
        sites.start(who);
        break;
      case 1:  // killed
        sites.stop(who);
        sites.run(random.uniform(0.0, 2.0));
        sites.start(who);
        break;
      case 2:  // another port
        sites.at(who).port->address.port = static_cast<std::uint16_t>(7000 + random.below(1000));
        break;
      default:  // both killed
        sites.stop(1);
        sites.stop(2);
        sites.start(1);
        sites.start(2);
    }
    sites.run(random.uniform(0.0, 0.5));
    for (const int id : {1, 2}) sites.at(id).port->address.port = 7000;
    ASSERT_TRUE(sites.goLive(30.0));
  }
}

}  // namespace
}  // namespace tandem
