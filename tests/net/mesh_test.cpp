// Two and more sites over a virtual network, from the first datagram to BYE.

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "net/tagged_datagrams.h"
#include "net/virtual_net.h"

namespace tandem {
namespace {

using net::Refusal;
using test::NetConditions;
using test::VirtualNet;
using test::VirtualSites;

TEST(Mesh, GoesLiveInFourRoundTrips) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  EXPECT_LT(sites.clock(), 4 * 2 * sites.net.conditions.delay + 0.01);
  sites.run(1.0);
  for (const int id : {1, 2}) {
    const auto& given = sites.at(id).given[static_cast<std::size_t>(3 - id)];
    EXPECT_GT(given.size(), 115u);
    const PeerStatus status = sites.status(id, 3 - id);
    EXPECT_NEAR(status.round_trip, 0.04, 2e-3);
    EXPECT_NEAR(status.clock_offset, 0.0, 2e-3);
    EXPECT_EQ(status.loss, 0.0);
  }
}

TEST(Mesh, StatesComeWholeAndInOrder) {
  VirtualSites sites(2, {0.05, 0.02, 0.05, 0.05, 0.0}, 7);
  ASSERT_TRUE(sites.goLive(5.0));
  sites.run(10.0);
  double last = -1.0;
  int counted = 0;
  for (const Arrival& arrival : sites.at(2).given[1]) {
    EXPECT_GT(arrival.packet.time, last);
    last = arrival.packet.time;
    EXPECT_EQ(arrival.packet.sender, PeerId{1});
    // The wire carries float32.
    const Vec3 sent = VirtualSites::positionAt(arrival.packet.time, 1);
    EXPECT_LT((arrival.packet.user.p_W - sent).norm(), 1e-6 * arrival.packet.time);
    ++counted;
  }
  EXPECT_GT(counted, 1000);
  EXPECT_NEAR(sites.status(2, 1).loss, 0.05, 0.06);
}

TEST(Mesh, StatesThatMayNotBeSentAreCounted) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  const PeerStatus before = sites.status(1, 2);
  StatePacket packet;
  packet.sender = PeerId{1};
  packet.sequence = 1'000'000;
  packet.user.p_W.x() = 1001.0;
  sites.at(1).mesh->link(PeerId{2}).send(packet, sites.clock());
  EXPECT_EQ(sites.status(1, 2).states_sent, before.states_sent);
  EXPECT_EQ(sites.status(1, 2).states_unsent, before.states_unsent + 1);
  packet.user.p_W.x() = 1000.0;
  sites.at(1).mesh->link(PeerId{2}).send(packet, sites.clock());
  EXPECT_EQ(sites.status(1, 2).states_sent, before.states_sent + 1);
}

// Both sides of a handshake know that the other understands grips.
TEST(Mesh, GripsArrive) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  for (const std::uint32_t id : {1u, 2u}) {
    StatePacket packet;
    packet.sender = PeerId{id};
    packet.sequence = 1'000'000;
    packet.time = sites.clock();
    packet.grip.emplace().object = 2;
    sites.at(static_cast<int>(id)).mesh->link(PeerId{3 - id}).send(packet, sites.clock());
  }
  sites.run(0.5);
  for (const int id : {1, 2}) {
    int grips = 0;
    for (const Arrival& arrival : sites.at(id).given[static_cast<std::size_t>(3 - id)])
      grips += arrival.packet.grip && arrival.packet.grip->object == 2u;
    EXPECT_EQ(grips, 1) << "at site " << id;
  }
}

TEST(Mesh, JitterBecomesConstantDelay) {
  VirtualSites sites(2, {0.05, 0.02, 0.0, 0.0, 0.0}, 8);
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(4.0);
  sites.at(2).given[1].clear();
  sites.run(10.0);
  double least = 1e9, most = 0.0;
  for (const Arrival& arrival : sites.at(2).given[1]) {
    least = std::min(least, arrival.time - arrival.packet.time);
    most = std::max(most, arrival.time - arrival.packet.time);
  }
  EXPECT_NEAR(least, 0.07, 0.003);
  EXPECT_NEAR(most, 0.07, 0.003);
}

TEST(Mesh, EightPeers) {
  VirtualSites sites(8);
  ASSERT_TRUE(sites.goLive(2.0));
  sites.run(0.5);
  for (int id = 1; id <= 8; ++id)
    for (int other = 1; other <= 8; ++other)
      if (id != other) {
        EXPECT_GT(sites.at(id).given[static_cast<std::size_t>(other)].size(), 30u);
      }
}

TEST(Mesh, LateComerIsTakenIn) {
  VirtualSites sites(3);
  sites.stop(3);
  sites.run(10.0);
  EXPECT_EQ(sites.status(1, 2).phase, PeerPhase::kLive);
  EXPECT_EQ(sites.status(1, 3).phase, PeerPhase::kCalling);
  sites.start(3);
  EXPECT_TRUE(sites.goLive(1.5));
}

TEST(Mesh, HandshakeSurvivesABadNetwork) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    VirtualSites sites(2, {0.25, 0.25, 0.25, 0.25, 0.05}, seed);
    EXPECT_TRUE(sites.goLive(60.0));
  }
}

TEST(Mesh, AnotherKeyIsRefusedAndSaid) {
  VirtualSites sites(2);
  sites.start(2, 0x43);
  sites.run(3.0);
  EXPECT_EQ(sites.status(1, 2).phase, PeerPhase::kCalling);
  ASSERT_TRUE(sites.status(1, 2).refused);
  EXPECT_EQ(*sites.status(1, 2).refused, RefuseCode::kKey);
  EXPECT_TRUE(sites.status(2, 1).is_called_with_another_key);
  EXPECT_GT(sites.at(2).mesh->counts().of(Refusal::kKey), 0u);
  EXPECT_TRUE(sites.at(1).given[2].empty());
  sites.start(2);
  ASSERT_TRUE(sites.goLive(2.0));
  EXPECT_FALSE(sites.status(1, 2).refused);
  EXPECT_FALSE(sites.status(2, 1).is_called_with_another_key);
}

TEST(Mesh, OtherConfigurationsAreComparedByName) {
  VirtualSites sites(2);
  sites.start(2, 0x42,
              makeConfiguration({{"coordination.stiffness", "200"}, {"object.mass", "0.3"}}));
  sites.run(2.0);
  for (const int id : {1, 2}) {
    const PeerStatus status = sites.status(id, 3 - id);
    EXPECT_EQ(status.phase, PeerPhase::kDifferent);
    ASSERT_TRUE(status.difference);
    EXPECT_EQ(status.difference->key, "coordination.stiffness");
    EXPECT_EQ(id == 2 ? status.difference->here : status.difference->there, "200");
    EXPECT_TRUE(sites.at(id).given[static_cast<std::size_t>(3 - id)].empty());
    EXPECT_GT(sites.at(id).mesh->counts().of(Refusal::kNotAgreed), 0u);
  }
  // A leaving site gives its reason, and the other still knows it.
  sites.at(1).mesh->leave(ByeReason::kConfigurationsDiffer, sites.clock());
  sites.run(0.3);
  EXPECT_EQ(sites.status(2, 1).phase, PeerPhase::kLeft);
  EXPECT_EQ(sites.status(2, 1).left, ByeReason::kConfigurationsDiffer);
  ASSERT_TRUE(sites.status(2, 1).difference);
  EXPECT_EQ(sites.status(2, 1).difference->key, "coordination.stiffness");
  // The cause is mended, and the site restarts.
  sites.start(1);
  sites.start(2);
  EXPECT_TRUE(sites.goLive(3.0));
}

TEST(Mesh, AnotherVersionIsToldOurs) {
  VirtualSites sites(2);
  sites.stop(1);
  std::vector<std::uint8_t> hello(kHelloSize, 0);
  ASSERT_GT(encodeHello({{PeerId{1}, PeerId{2}, 77}, {}}, {hello.data(), hello.size()}), 0u);
  hello[2] = 9;
  std::vector<std::uint8_t> answer;
  sites.net.tap = [&](const auto& bytes, const auto&, const auto&) { answer = bytes; };
  sites.at(2).mesh->receive({hello.data(), hello.size()}, VirtualNet::addressOf(1), 0.0);
  const auto refuse = decodeRefuse({answer.data(), answer.size()});
  ASSERT_TRUE(refuse);
  EXPECT_EQ(refuse->code, RefuseCode::kVersion);
  EXPECT_EQ(refuse->version, kWireVersion);
}

TEST(Mesh, StrangersGetLessThanTheySend) {
  VirtualSites sites(2);
  sites.stop(1);
  std::uint64_t out = 0, in = 0;
  sites.net.tap = [&](const auto& bytes, const auto&, const auto&) { out += bytes.size(); };
  const auto throwAt = [&](std::vector<std::uint8_t> bytes, double now) {
    in += bytes.size();
    sites.at(2).mesh->receive({bytes.data(), bytes.size()}, VirtualNet::addressOf(9), now);
    EXPECT_LE(out, in);
  };
  for (int i = 0; i < 1000; ++i) {
    const double now = 1e-3 * i;
    std::vector<std::uint8_t> hello(kHelloSize);
    // A copy of the peer's own, then one that nobody with the key has made.
    (void)net::writeHello({PeerId{1}, PeerId{2}, 77}, test::makeKey(0x42),
                          {hello.data(), hello.size()});
    throwAt(hello, now);
    (void)encodeHello({{PeerId{1}, PeerId{3}, 77}, {}}, {hello.data(), hello.size()});
    throwAt(hello, now);
    OpenMessage open;
    open.route = {PeerId{1}, PeerId{2}, 5};
    open.key_epoch = 1;
    net::tagOpen(open, test::makeKey(0x42));
    std::vector<std::uint8_t> bytes(kOpenSize);
    (void)encodeOpen(open, {bytes.data(), bytes.size()});
    throwAt(bytes, now);
  }
  EXPECT_GT(sites.at(2).mesh->counts().of(Refusal::kTooMany), 0u);
  EXPECT_EQ(sites.at(2).mesh->counts().of(Refusal::kCookie), 1000u);
  EXPECT_EQ(sites.status(2, 1).phase, PeerPhase::kCalling);
}

TEST(Mesh, RestartedPeerGoesOnWhereItEnded) {
  for (const int restarted : {1, 2}) {
    SCOPED_TRACE(restarted);
    VirtualSites sites(2);
    ASSERT_TRUE(sites.goLive(1.0));
    sites.run(2.0);
    sites.stop(restarted);
    sites.run(0.3);
    sites.start(restarted);
    sites.run(4.0);
    EXPECT_TRUE(sites.areLive());
    const int other = 3 - restarted;
    std::uint64_t last = 0;
    double newest = 0.0;
    for (const Arrival& arrival : sites.at(other).given[static_cast<std::size_t>(restarted)]) {
      EXPECT_GT(arrival.packet.sequence + 1, last);
      last = arrival.packet.sequence + 1;
      newest = arrival.packet.time;
    }
    EXPECT_GT(newest, sites.clock() - 0.1);
  }
}

// It knows where the initiator is, and asks to be called.
TEST(Mesh, ResponderThatRestartsElsewhereIsFound) {
  for (const double delay : {0.002, 0.05, 0.3}) {
    SCOPED_TRACE(delay);
    VirtualSites sites(2, {delay, 0.0, 0.0, 0.0, 0.0});
    ASSERT_TRUE(sites.goLive(20 * delay + 1.0));
    sites.run(2.0);
    sites.stop(2);
    sites.run(3.0);
    const Address elsewhere = VirtualNet::addressOf(5);
    sites.at(2).port->address = elsewhere;
    sites.start(2);
    EXPECT_TRUE(sites.goLive(2.0 + 20 * delay));
    EXPECT_EQ(sites.status(1, 2).address, elsewhere);
    sites.forgetGiven();
    sites.run(1.0);
    EXPECT_GT(sites.at(1).given[2].size(), 100u);
    EXPECT_GT(sites.at(2).given[1].size(), 100u);
  }
}

// Nobody needs to be called: what was recorded of such a question has no answer.
TEST(Mesh, AskingForACallChangesNoLiveSession) {
  VirtualSites sites(2);
  std::vector<std::uint8_t> knock;
  sites.net.tap = [&](const auto& bytes, const auto& from, const auto&) {
    if (bytes[3] == static_cast<std::uint8_t>(MessageType::kHello) &&
        from == VirtualNet::addressOf(2))
      knock = bytes;
  };
  ASSERT_TRUE(sites.goLive(1.0));
  ASSERT_FALSE(knock.empty());
  const std::uint16_t epoch = sites.status(1, 2).key_epoch;
  std::size_t answers = 0;
  sites.net.tap = [&](const auto&, const auto&, const auto& to) {
    if (to == VirtualNet::addressOf(9)) ++answers;
  };
  for (int i = 0; i < 1000; ++i) {
    sites.net.carry(knock, VirtualNet::addressOf(9), VirtualNet::addressOf(1));
    sites.step();
  }
  EXPECT_EQ(answers, 0u);
  EXPECT_EQ(sites.status(1, 2).key_epoch, epoch);
  EXPECT_TRUE(sites.areLive());
}

TEST(Mesh, KeysAreRenewedWithoutAGap) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  const std::uint16_t epoch = sites.status(1, 2).key_epoch;
  std::set<std::vector<std::uint8_t>> headers;
  sites.net.tap = [&](const auto& bytes, const auto& from, const auto&) {
    if (bytes[3] < 16) return;
    // Nonce and key together: sender's port, session, epoch, sequence.
    std::vector<std::uint8_t> nonce(bytes.begin() + 4, bytes.begin() + 20);
    nonce.push_back(from.ip[15]);
    EXPECT_TRUE(headers.insert(nonce).second);
  };
  sites.run(130.0);
  EXPECT_NE(sites.status(1, 2).key_epoch, epoch);
  double last = 0.0;
  for (const Arrival& arrival : sites.at(2).given[1]) {
    if (last > 0.0) {
      EXPECT_LT(arrival.time - last, 0.02);
    }
    last = arrival.time;
  }
  EXPECT_GT(last, sites.clock() - 0.05);
}

// The old keys open datagrams until the responder switches to the new ones, however late.
TEST(Mesh, KeysAreRenewedWithoutAGapOnALongWay) {
  for (const double delay : {0.5, 1.5, 3.0}) {
    SCOPED_TRACE(delay);
    VirtualSites sites(2, {delay, 0.0, 0.0, 0.0, 0.0});
    ASSERT_TRUE(sites.goLive(10 * delay));
    sites.run(2 * delay);
    const std::uint16_t epoch = sites.status(1, 2).key_epoch;
    sites.forgetGiven();
    sites.run(150.0);
    EXPECT_NE(sites.status(2, 1).key_epoch, epoch);
    for (const int id : {1, 2}) {
      SCOPED_TRACE(id);
      double last = 0.0, longest = 0.0;
      for (const Arrival& arrival : sites.at(id).given[static_cast<std::size_t>(3 - id)]) {
        if (last > 0.0) longest = std::max(longest, arrival.time - last);
        last = arrival.time;
      }
      EXPECT_LT(longest, 0.02);
      EXPECT_GT(last, sites.clock() - 0.02);
    }
  }
}

// New keys carry nothing before one round trip is over. That is not silence.
TEST(Mesh, KeysAreNotRenewedBeforeTheyAreDue) {
  for (const double delay : {0.02, 0.6, 1.0, 2.5}) {
    SCOPED_TRACE(delay);
    VirtualSites sites(2, {delay, 0.1, 0.0, 0.0, 0.0});
    std::set<std::uint16_t> epochs;
    sites.net.tap = [&](const auto& bytes, const auto&, const auto&) {
      if (bytes[3] == static_cast<std::uint8_t>(MessageType::kOpen))
        epochs.insert(static_cast<std::uint16_t>(bytes[10] | bytes[11] << 8));
    };
    ASSERT_TRUE(sites.goLive(30.0));
    sites.run(100.0);
    EXPECT_EQ(epochs.size(), 1u);
    sites.run(120.0);
    EXPECT_EQ(epochs.size(), 2u);
  }
}

TEST(Mesh, KeysAreRenewedThroughLoss) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    VirtualSites sites(2, {1.0, 0.1, 0.5, 0.25, 0.0}, seed);
    ASSERT_TRUE(sites.goLive(60.0));
    std::uint16_t epoch = sites.status(2, 1).key_epoch;
    for (int renewal = 0; renewal < 3; ++renewal) {
      sites.run(170.0);  // before 180 s
      EXPECT_NE(sites.status(2, 1).key_epoch, epoch);
      epoch = sites.status(2, 1).key_epoch;
      EXPECT_TRUE(sites.areLive());
    }
  }
}

TEST(Mesh, FollowsAPeerToAnotherAddress) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  sites.at(2).port->address.port = 7999;  // as a NAT changes it
  sites.run(1.0);
  EXPECT_EQ(sites.status(1, 2).address->port, 7999);
  EXPECT_TRUE(sites.areLive());
  EXPECT_GT(sites.at(2).given[1].back().packet.time, sites.clock() - 0.05);
}

TEST(Mesh, FirstDatagramAfterAnOutageCounts) {
  for (const double outage : {0.25, 1.0, 5.0, 60.0}) {
    SCOPED_TRACE(outage);
    VirtualSites sites(2);
    ASSERT_TRUE(sites.goLive(1.0));
    sites.run(1.0);
    sites.net.is_down = true;
    sites.run(outage);
    const std::size_t before = sites.at(2).given[1].size();
    sites.net.is_down = false;
    const double back = sites.clock();
    while (sites.at(2).given[1].size() == before && sites.clock() < back + 5.0) sites.step();
    EXPECT_LT(sites.clock() - back, 2 * sites.net.conditions.delay + 0.02);
    sites.run(1.0);
    EXPECT_TRUE(sites.areLive());
  }
}

TEST(Mesh, FarewellIsHeardThroughLoss) {
  VirtualSites sites(2, {0.02, 0.0, 0.5, 0.0, 0.0}, 11);
  ASSERT_TRUE(sites.goLive(60.0));
  sites.at(1).mesh->leave(ByeReason::kUserLeaves, sites.clock());
  sites.run(0.3);
  EXPECT_EQ(sites.status(2, 1).phase, PeerPhase::kLeft);
  EXPECT_EQ(sites.status(2, 1).left, ByeReason::kUserLeaves);
  EXPECT_FALSE(sites.status(2, 1).difference);
  sites.start(1);
  EXPECT_TRUE(sites.goLive(60.0));
  EXPECT_FALSE(sites.status(2, 1).left);
}

TEST(Mesh, LeaverWithTheHigherIdMayComeBack) {
  VirtualSites sites(2);
  ASSERT_TRUE(sites.goLive(1.0));
  sites.at(2).mesh->leave(ByeReason::kUserLeaves, sites.clock());
  sites.run(3.0);
  EXPECT_EQ(sites.status(1, 2).phase, PeerPhase::kLeft);
  sites.start(2);
  EXPECT_TRUE(sites.goLive(2.0));
}

TEST(Mesh, RefusesIdsThatCannotBe) {
  VirtualNet net;
  VirtualNet::Port port(net, VirtualNet::addressOf(1));
  const auto make = [&](std::uint32_t self, std::vector<std::uint32_t> ids) {
    std::vector<net::PeerGroup::Peer> peers;
    for (const std::uint32_t id : ids)
      peers.push_back({PeerId{id}, std::nullopt, test::makeKey(1)});
    const net::PeerGroup mesh(PeerId{self}, std::move(peers), {}, port);
  };
  EXPECT_THROW(make(0, {2}), std::invalid_argument);
  EXPECT_THROW(make(1, {65}), std::invalid_argument);
  EXPECT_THROW(make(1, {1}), std::invalid_argument);
  EXPECT_THROW(make(1, {2, 2}), std::invalid_argument);
  EXPECT_THROW(make(1, {2}), std::invalid_argument);  // no site would call
  EXPECT_NO_THROW(make(3, {1, 2}));
}

}  // namespace
}  // namespace tandem
