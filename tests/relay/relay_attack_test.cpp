// Strangers, listeners and a relay that lies. In no case is something delivered that its sender did
// not say to this receiver.

#include <gtest/gtest.h>

#include "net/attack.h"
#include "relay/relay_rig.h"
#include "relay/relayed_sites.h"

namespace tandem {
namespace {

using relay::Result;
using test::Bytes;
using test::Injector;
using test::kStranger;
using test::makeInner;
using test::relayAddress;
using test::RelayedSites;
using test::RelayOfTwo;
using test::RelayRig;
using test::VirtualNet;

/// Bytes that came to a stranger, and that went out in its name.
struct Account {
  std::uint64_t asked = 0, got = 0;
};

/// Copies of everything that goes to the relay, first, from a stranger's address.
Account copyAll(RelayRig& rig, double seconds) {
  Injector copies(rig.net);
  Account account;
  rig.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (to == kStranger) account.got += bytes.size();
    if (copies.isOwn() || to != relayAddress() || from == kStranger) return;
    account.asked += bytes.size();
    copies.send(bytes, kStranger, to);
  };
  rig.run(seconds);
  rig.net.tap = nullptr;
  return account;
}

TEST(RelayAttack, CopiesThatArriveFirstMoveNobodyAndAreDeliveredOnce) {
  RelayOfTwo rig;
  for (int i = 0; i < 100; ++i) {
    rig.say(rig.first, 2, makeInner(static_cast<std::uint8_t>(i)));
    (void)copyAll(rig, 0.05);
  }
  ASSERT_EQ(rig.second.heard.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i)
    EXPECT_EQ(rig.second.heard[i].second, makeInner(static_cast<std::uint8_t>(i)));
  rig.say(rig.second, 1, makeInner(7));
  rig.run(0.1);
  EXPECT_EQ(rig.first.heard.size(), 1u);
}

TEST(RelayAttack, AStrangerGetsLessThanItSends) {
  RelayRig rig;
  rig.join(1, 1);
  rig.join(2, 2, "lab", 0x18);  // with another key
  const Account account = copyAll(rig, 60.0);
  EXPECT_GT(account.asked, 0u);
  EXPECT_LT(account.got, account.asked);
}

TEST(RelayAttack, ARecordedAdmissionIsNotTakenFromElsewhereNorLater) {
  RelayRig rig;
  std::vector<Bytes> recorded;
  rig.net.tap = [&](const Bytes& bytes, const Address&, const Address& to) {
    if (to == relayAddress()) recorded.push_back(bytes);
  };
  rig.join(1, 1);
  rig.run(2.0);
  rig.net.tap = nullptr;
  for (const Bytes& bytes : recorded) rig.net.carry(bytes, kStranger, relayAddress());
  rig.run(1.0);
  EXPECT_EQ(rig.relay->members().count(), 1u);
  rig.members[1].member.reset();
  rig.run(30.0);
  for (const Bytes& bytes : recorded)
    rig.net.carry(bytes, VirtualNet::addressOf(1), relayAddress());
  rig.run(1.0);
  EXPECT_EQ(rig.relay->members().count(), 0u);
}

TEST(RelayAttack, AFloodOfForgedDatagramsDeliversNothingAndLosesNothing) {
  RelayOfTwo rig;
  Bytes heard_on_the_way;
  rig.net.tap = [&](const Bytes& bytes, const Address& from, const Address& to) {
    if (to == relayAddress() && from != kStranger) heard_on_the_way = bytes;
  };
  test::Random random(20260101);
  for (int i = 0; i < 500; ++i) {
    rig.say(rig.first, 2, makeInner(static_cast<std::uint8_t>(i)));
    for (int k = 0; k < 100; ++k) {  // 100,000 a second
      Bytes forged = heard_on_the_way;
      forged[9] = 0x40;  // a sequence far ahead
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(forged.size())));
      forged[at] ^= static_cast<std::uint8_t>(1 + random.below(255));
      rig.net.carry(forged, kStranger, relayAddress());
    }
    rig.step();
  }
  rig.run(0.2);
  EXPECT_EQ(rig.second.heard.size(), 500u);
  EXPECT_EQ(rig.first.heard.size(), 0u);
  EXPECT_GT(rig.count(Result::kForged), 20'000u);
}

/// Runs two sites whose relay does `lie`. All states that come are whole, and in order.
void expectTrueStates(const std::function<void(Bytes&, Address&)>& lie, bool come) {
  RelayedSites sites(3, {.has_direct = false});
  ASSERT_TRUE(sites.goLive(2.0));
  sites.relay_port.lie = lie;
  sites.run(5.0);
  for (const int at : {1, 2, 3}) {
    for (const int of : {1, 2, 3}) {
      if (at == of) continue;
      double last = -1.0;
      for (const Arrival& arrival : sites.at(at).given[static_cast<std::size_t>(of)]) {
        const Vec3 said = test::VirtualSites::positionAt(arrival.packet.time, of);
        EXPECT_LT((arrival.packet.user.p_W - said).norm(), 1e-5);
        EXPECT_GT(arrival.packet.time, last);
        last = arrival.packet.time;
      }
      if (come) {
        EXPECT_GT(last, sites.now() - 0.5) << at << of;
      }
    }
  }
}

TEST(LyingRelay, NamesAnotherSender) {
  int count = 0;
  expectTrueStates(
      [&](Bytes& bytes, Address&) {
        if (++count % 3 == 0 && bytes.size() > 100)
          bytes[16] = static_cast<std::uint8_t>(1 + count % 3);
      },
      true);
}

TEST(LyingRelay, SendsToAnotherMember) {
  int count = 0;
  expectTrueStates(
      [&](Bytes&, Address& to) {
        if (++count % 3 == 0) to = VirtualNet::addressOf(1 + count / 3 % 3);
      },
      true);
}

TEST(LyingRelay, ChangesBytes) {
  test::Random random(5);
  expectTrueStates(
      [&](Bytes& bytes, Address&) {
        if (random.below(3) == 0)
          bytes[static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())))] ^= 1;
      },
      true);
}

TEST(LyingRelay, RepeatsWhatItHeardBefore) {
  std::vector<Bytes> kept;
  test::Random random(5);
  expectTrueStates(
      [&](Bytes& bytes, Address&) {
        kept.push_back(bytes);
        if (random.below(2) == 0)
          bytes = kept[static_cast<std::size_t>(random.below(static_cast<int>(kept.size())))];
      },
      true);
}

TEST(LyingRelay, SendsNothingAnyMore) {
  expectTrueStates([](Bytes& bytes, Address&) { bytes.assign(20, 0); }, false);
}

}  // namespace
}  // namespace tandem
