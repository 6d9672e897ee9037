// A relay and its members in virtual time: admission, forwarding, limits, farewell.

#include "relay/relay.h"

#include <gtest/gtest.h>

#include "relay/relay_rig.h"

namespace tandem {
namespace {

using relay::Code;
using relay::Result;
using test::Bytes;
using test::makeInner;
using test::RelayOfTwo;
using test::RelayRig;
using test::VirtualNet;

TEST(Relay, ForwardsWhatAMemberSaysUnchanged) {
  RelayOfTwo rig;
  ASSERT_TRUE(rig.first.member->isIn() && rig.second.member->isIn());
  for (const std::size_t size : {std::size_t{20}, std::size_t{172}, kMaxDatagramSize}) {
    rig.say(rig.first, 2, makeInner(7, size));
    rig.say(rig.second, 1, makeInner(8, size));
    rig.run(0.1);
    ASSERT_EQ(rig.second.heard.size(), 1u);
    EXPECT_EQ(rig.second.heard[0].first, 1);
    EXPECT_EQ(rig.second.heard[0].second, makeInner(7, size));
    ASSERT_EQ(rig.first.heard.size(), 1u);
    EXPECT_EQ(rig.first.heard[0].second, makeInner(8, size));
    rig.first.heard.clear(), rig.second.heard.clear();
  }
  EXPECT_EQ(rig.relay->counts().forwarded, 6u);
}

TEST(Relay, LetsAMemberInAfterTwoRoundTrips) {
  RelayRig rig;
  auto& member = rig.join(1, 1);
  rig.run(4 * rig.net.conditions.delay + 0.005);
  EXPECT_TRUE(member.member->isIn());
}

TEST(Relay, KeepsRoomsApart) {
  RelayRig rig;
  auto& first = rig.join(1, 1, "lab");
  auto& second = rig.join(2, 2, "class");
  rig.run(1.0);
  rig.say(first, 2, makeInner(7));
  rig.run(0.1);
  EXPECT_TRUE(second.heard.empty());
  EXPECT_EQ(rig.count(Result::kNoReceiver), 1u);
}

TEST(Relay, TellsWhereTheOthersAre) {
  RelayRig rig;
  auto& first = rig.join(1, 1);
  rig.join(2, 2);
  rig.run(1.0);
  const auto seen = first.member->takeSeen();
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->member, PeerId{2});
  EXPECT_EQ(seen->address, VirtualNet::addressOf(2));
}

TEST(Relay, RefusesAnotherKey) {
  RelayRig rig;
  auto& member = rig.join(1, 1, "lab", 0x18);
  rig.run(1.0);
  EXPECT_FALSE(member.member->isIn());
  ASSERT_TRUE(member.member->refused());
  EXPECT_EQ(member.member->refused()->code, Code::kKey);
}

TEST(Relay, RefusesAnIdThatIsThere) {
  RelayOfTwo rig;
  auto& impostor = rig.join(3, 2);
  rig.run(10.0);
  EXPECT_FALSE(impostor.member->isIn());
  ASSERT_TRUE(impostor.member->refused());
  EXPECT_EQ(impostor.member->refused()->code, Code::kTaken);
  rig.say(rig.first, 2, makeInner(7));
  rig.run(0.1);
  EXPECT_EQ(rig.second.heard.size(), 1u);
}

TEST(Relay, TakesAMemberThatBeganAnewAtOnceAtItsAddressAndElsewhereAfterFiveSeconds) {
  RelayRig rig;
  rig.join(1, 1);
  rig.run(1.0);
  rig.join(1, 1);
  rig.run(0.5);
  EXPECT_TRUE(rig.members[1].member->isIn());
  rig.members[1].member.reset();
  rig.join(3, 1);
  rig.run(4.0);
  EXPECT_FALSE(rig.members[3].member->isIn());
  rig.run(3.0);
  EXPECT_TRUE(rig.members[3].member->isIn());
}

TEST(Relay, RefusesMoreMembersAndRoomsThanItHas) {
  RelaySettings settings;
  settings.rooms = 2;
  settings.members = 3;
  RelayRig rig(settings);
  for (std::uint16_t id = 1; id <= 4; ++id) rig.join(id, id);
  rig.join(11, 1, "class");
  rig.run(1.0);
  rig.join(12, 1, "third");
  rig.run(1.0);
  int in = 0;
  for (int i = 1; i <= 4; ++i) {
    const auto& member = *rig.members[i].member;
    in += member.isIn() ? 1 : 0;
    if (!member.isIn()) {
      EXPECT_EQ(member.refused()->code, Code::kMembers);
    }
  }
  EXPECT_EQ(in, 3);
  EXPECT_EQ(rig.members[12].member->refused()->code, Code::kRooms);
}

TEST(Relay, APlaceIsFreeAfterAFarewellAndAfterTenSilentSeconds) {
  RelayRig rig;
  rig.join(1, 1).member->advance(0.0);
  rig.join(2, 2);
  rig.run(1.0);
  EXPECT_EQ(rig.relay->members().count(), 2u);
  rig.members[1].member->leave();
  rig.members[1].member.reset();
  rig.run(0.1);
  EXPECT_EQ(rig.relay->members().count(), 1u);
  rig.members[2].member.reset();
  rig.run(9.0);
  EXPECT_EQ(rig.relay->members().count(), 1u);
  rig.run(2.0);
  EXPECT_EQ(rig.relay->members().count(), 0u);
}

TEST(Relay, DropsWhatIsBeyondAMembersRate) {
  RelaySettings settings;
  settings.datagram_rate = 100.0;
  RelayOfTwo rig(1.0, settings);
  for (int i = 0; i < 1000; ++i, rig.step()) rig.say(rig.first, 2, makeInner(7));
  rig.run(0.1);
  // A burst of 64, and 100 a second.
  EXPECT_NEAR(static_cast<double>(rig.second.heard.size()), 164.0, 8.0);
  EXPECT_EQ(rig.count(Result::kTooMany), 1000u - rig.second.heard.size());
  rig.say(rig.second, 1, makeInner(8));
  rig.run(0.1);
  EXPECT_EQ(rig.first.heard.size(), 1u);
}

TEST(Relay, ARestartedRelayIsJoinedAgain) {
  RelayOfTwo rig(3.0);
  rig.startRelay();
  rig.run(1.5);
  rig.say(rig.first, 2, makeInner(7));
  rig.run(0.1);
  EXPECT_EQ(rig.second.heard.size(), 1u);
}

TEST(Relay, ASilentRelayIsNoticed) {
  RelayRig rig;
  auto& member = rig.join(1, 1);
  rig.run(3.0);
  rig.stopRelay();
  rig.run(4.0);
  EXPECT_GT(member.member->silence(rig.net.now), 3.0);
}

TEST(Relay, FollowsAPortThatANatChanged) {
  RelayOfTwo rig(3.0);
  rig.second.port->address.port = 7999;
  rig.say(rig.second, 1, makeInner(8));
  rig.run(0.6);
  EXPECT_EQ(rig.first.heard.size(), 1u);
  rig.say(rig.first, 2, makeInner(7));
  rig.run(0.1);
  EXPECT_EQ(rig.second.heard.size(), 1u);
}

TEST(Relay, WatchersHearWhatIsSaidToAllOfThemAndSayNothing) {
  RelayRig rig;
  auto& player = rig.join(1, 1);
  auto& other = rig.join(2, 2);
  std::vector<RelayRig::Member*> watchers;
  for (const int number : {3, 4, 5})
    watchers.push_back(&rig.joinAt(VirtualNet::addressOf(number), number,
                                   static_cast<std::uint16_t>(number), "lab", RelayRig::kKey,
                                   true));
  rig.run(1.0);
  rig.say(player, relay::kAllWatchers, makeInner(7));
  for (auto* watcher : watchers) rig.say(*watcher, 1, makeInner(8));
  rig.say(*watchers[0], relay::kAllWatchers, makeInner(9));
  rig.run(0.1);
  for (auto* watcher : watchers) {
    ASSERT_EQ(watcher->heard.size(), 1u);
    EXPECT_EQ(watcher->heard[0], std::make_pair(std::uint16_t{1}, makeInner(7)));
  }
  EXPECT_TRUE(player.heard.empty() && other.heard.empty());
  EXPECT_EQ(rig.count(Result::kWatcher), 4u);
  EXPECT_EQ(rig.relay->members().rooms()[0].watchers, 3);
  rig.members[3].member->leave();
  rig.members[3].member.reset();
  rig.run(0.1);
  EXPECT_EQ(rig.relay->members().rooms()[0].watchers, 2);
}

TEST(Relay, WithoutWatchersNothingIsForwardedToThem) {
  RelayRig rig;
  auto& player = rig.join(1, 1);
  rig.run(1.0);
  rig.say(player, relay::kAllWatchers, makeInner(7));
  rig.run(0.1);
  EXPECT_EQ(rig.count(Result::kNoReceiver), 1u);
  EXPECT_EQ(rig.relay->counts().forwarded, 0u);
}

TEST(Relay, SettingsOutOfRangeAreRefused) {
  test::VirtualNet net;
  VirtualNet::Port port(net, test::relayAddress());
  const auto make = [&](auto change) {
    RelaySettings settings;
    change(settings);
    relay::Relay(settings, test::makeKey(1), port);
  };
  EXPECT_THROW(make([](auto& s) { s.rooms = 0; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& s) { s.members = 65; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& s) { s.members = 1; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& s) { s.rooms = 10'000; }), std::invalid_argument);
  EXPECT_THROW(make([](auto& s) { s.datagram_rate = 0.0; }), std::invalid_argument);
  EXPECT_NO_THROW(make([](auto&) {}));
}

}  // namespace
}  // namespace tandem
