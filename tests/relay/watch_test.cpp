// Spectators of a room: what players say to them, and what they cannot say.

#include <gtest/gtest.h>

#include "net/peer_group.h"
#include "relay/relay_rig.h"
#include "relay/watch_feed.h"
#include "relay/watched_room.h"

namespace tandem {
namespace {

using relay::WatchedRoom;
using test::Bytes;
using test::makeKey;
using test::VirtualNet;

constexpr std::uint8_t kWatchKey = 0x55;

StatePacket makePacket(std::uint64_t sequence, double x, int objects = 1) {
  StatePacket packet;
  packet.sender = PeerId{1};
  packet.sequence = sequence;
  packet.time = 1e-3 * static_cast<double>(sequence);
  packet.user.p_W = {x, 0.0, 0.0};
  packet.energy = EnergyReport{1.0, 2.0};
  packet.object_count = static_cast<std::uint32_t>(objects);
  for (int i = 0; i < objects; ++i) {
    packet.objects[static_cast<std::size_t>(i)].id = static_cast<ObjectId>(i);
    packet.objects[static_cast<std::size_t>(i)].state.p_W = {x, 1.0 * i, 0.0};
  }
  return packet;
}

/// Keeps what is sent.
struct Record final : net::Outlet {
  void send(ByteView datagram, const Address& to) noexcept override {
    sent.emplace_back(datagram.data, datagram.data + datagram.size);
    receiver = to;
  }
  std::vector<Bytes> sent;
  Address receiver;
};

/// Site 1 with its spectators' datagrams on record.
struct Player {
  explicit Player(relay::WatchRun run = {7, 9}, std::uint8_t key = kWatchKey)
      : feed(makeKey(key), PeerId{1}, run, WireProfile::kFloat64, 0x1234, out) {}
  Bytes say(double x) {
    now += relay::WatchFeed::kPeriod;
    feed.take(makePacket(sequence++, x), now);
    return out.sent.back();
  }
  Record out;
  relay::WatchFeed feed;
  double now = 0.0;
  std::uint64_t sequence = 0;
};

WatchedRoom::Result show(WatchedRoom& room, Bytes bytes, std::uint16_t member = 1) {
  return room.take(member, {bytes.data(), bytes.size()}, 1.0);
}

TEST(Watch, ShowsTheStateButNoEnergy) {
  Player player;
  WatchedRoom room(makeKey(kWatchKey));
  EXPECT_EQ(room.site(PeerId{1}), nullptr);
  ASSERT_EQ(show(room, player.say(0.25)), WatchedRoom::Result::kTaken);
  ASSERT_NE(room.site(PeerId{1}), nullptr);
  EXPECT_EQ(room.site(PeerId{1})->newest.user.p_W.x(), 0.25);
  EXPECT_EQ(room.site(PeerId{1})->config_hash, 0x1234u);
  EXPECT_FALSE(room.site(PeerId{1})->newest.energy);
  ASSERT_NE(room.object(PeerId{1}, 0), nullptr);
  EXPECT_EQ(room.object(PeerId{1}, 0)->state.p_W.x(), 0.25);
  EXPECT_EQ(room.object(PeerId{1}, 1), nullptr);
}

TEST(Watch, RefusesEveryChangedBitAndEveryTruncation) {
  Player player;
  const Bytes whole = player.say(0.25);
  WatchedRoom room(makeKey(kWatchKey));
  for (std::size_t i = 0; i < 8 * whole.size(); ++i) {
    Bytes changed = whole;
    changed[i / 8] ^= static_cast<std::uint8_t>(1 << i % 8);
    EXPECT_NE(show(room, changed), WatchedRoom::Result::kTaken) << "bit " << i;
  }
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(show(room, Bytes(whole.begin(), whole.begin() + static_cast<long>(size))),
              WatchedRoom::Result::kTaken);
  EXPECT_EQ(show(room, whole), WatchedRoom::Result::kTaken);
}

TEST(Watch, RefusesAnotherKeyAndAnotherMember) {
  Player stranger({8, 1}, 0x56);
  Player player;
  WatchedRoom room(makeKey(kWatchKey));
  EXPECT_EQ(show(room, stranger.say(0.1)), WatchedRoom::Result::kForged);
  EXPECT_EQ(show(room, player.say(0.1), 2), WatchedRoom::Result::kSender);
}

TEST(Watch, NewestWinsAndNothingIsTakenTwice) {
  Player player;
  const Bytes first = player.say(0.1), second = player.say(0.2);
  WatchedRoom room(makeKey(kWatchKey));
  EXPECT_EQ(show(room, second), WatchedRoom::Result::kTaken);
  EXPECT_EQ(show(room, second), WatchedRoom::Result::kOld);
  EXPECT_EQ(show(room, first), WatchedRoom::Result::kOld);
  EXPECT_EQ(room.site(PeerId{1})->newest.user.p_W.x(), 0.2);
}

TEST(Watch, TakesALaterRunAndNoneBefore) {
  Player before({7, 9}), later({8, 3});
  const Bytes recorded = before.say(0.1);
  WatchedRoom room(makeKey(kWatchKey));
  EXPECT_EQ(show(room, before.say(0.2)), WatchedRoom::Result::kTaken);
  EXPECT_EQ(show(room, later.say(0.3)), WatchedRoom::Result::kTaken);
  EXPECT_EQ(show(room, recorded), WatchedRoom::Result::kOld);
  EXPECT_EQ(show(room, before.say(0.4)), WatchedRoom::Result::kOld);
  EXPECT_EQ(room.site(PeerId{1})->newest.user.p_W.x(), 0.3);
}

TEST(Watch, RunsThatBeginAlikeHaveDifferentKeys) {
  Player one({7, 1}), other({7, 2});
  const Bytes a = one.say(0.1), b = other.say(0.1);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_NE(Bytes(a.begin() + relay::kWatchHeader, a.end()),
            Bytes(b.begin() + relay::kWatchHeader, b.end()));
}

TEST(Watch, PlayersRefuseItsBytesByForm) {
  Player player;
  Bytes bytes = player.say(0.1);
  Record out;
  std::vector<net::PeerGroup::Peer> peers;
  peers.push_back({PeerId{1}, std::nullopt, makeKey(kWatchKey), true});
  // Even one whose pair key is the watch key.
  net::PeerGroup mesh(PeerId{2}, std::move(peers), {}, out);
  mesh.receive({bytes.data(), bytes.size()}, net::makeRelayedAddress(PeerId{1}), 1.0);
  EXPECT_EQ(mesh.counts().form[static_cast<std::size_t>(WireRefusal::kMagic)], 1u);
  EXPECT_TRUE(out.sent.empty());
}

TEST(Watch, SendsOneDatagramInAPeriodHoweverManyPeers) {
  Player player;
  for (int tick = 0; tick < 10 * 128; ++tick)
    for (int peer = 0; peer < 7; ++peer)
      player.feed.take(makePacket(static_cast<std::uint64_t>(tick), 0.1), tick / 128.0);
  EXPECT_EQ(player.out.sent.size(), 10u * 32u);
  EXPECT_EQ(player.out.receiver, net::makeRelayedAddress(PeerId{relay::kAllWatchers}));
}

TEST(Watch, ObjectsThatTakeTurnsAllCome) {
  Player player;
  WatchedRoom room(makeKey(kWatchKey));
  for (int tick = 0; tick < 128; ++tick) {
    StatePacket packet = makePacket(static_cast<std::uint64_t>(tick), 0.1, 8);
    for (std::size_t i = 0; i < 8; ++i)
      packet.objects[i].id = static_cast<ObjectId>(8 * (tick % 4) + static_cast<int>(i));
    player.feed.take(packet, tick / 128.0);
  }
  for (const Bytes& bytes : player.out.sent) (void)show(room, bytes);
  for (ObjectId id = 0; id < 32; ++id) EXPECT_NE(room.object(PeerId{1}, id), nullptr) << id;
}

/// A player, another one and spectators in a room of a relay.
struct WatchRig : test::RelayRig {
  WatchRig() : first(join(1, 1)), second(join(2, 2)) {
    for (int i = 0; i < 2; ++i)
      spectators[i] = &joinAt(VirtualNet::addressOf(17 + i), 17 + i,
                              static_cast<std::uint16_t>(17 + i), "lab", kKey, true);
    run(1.0);
  }
  Member& first;
  Member& second;
  Member* spectators[2] = {};
};

TEST(WatchByRelay, TwoSpectatorsSeeWhatThePlayerSaysOnce) {
  WatchRig rig;
  relay::WatchFeed feed(makeKey(kWatchKey), PeerId{1}, {7, 9}, WireProfile::kFloat32, 0,
                        *rig.first.member);
  std::uint64_t said = 0;
  rig.net.tap = [&](const Bytes& bytes, const Address& from, const Address&) {
    said += from == rig.first.port->address && bytes[3] == 32;  // FORWARD
  };
  for (std::uint64_t i = 0; i < 125; ++i) {
    feed.take(makePacket(i, 0.5), rig.net.now);
    rig.run(8e-3);
  }
  rig.run(0.1);
  EXPECT_EQ(said, 32u);
  EXPECT_TRUE(rig.second.heard.empty());
  for (const auto* one : rig.spectators) {
    WatchedRoom room(makeKey(kWatchKey));
    for (const auto& [from, bytes] : one->heard)
      EXPECT_EQ(show(room, bytes, from), WatchedRoom::Result::kTaken);
    EXPECT_EQ(one->heard.size(), 32u);
  }
}

TEST(WatchByRelay, NothingOfASpectatorReachesAnybody) {
  WatchRig rig;
  Player forger;
  for (const std::uint16_t to : {std::uint16_t{1}, std::uint16_t{18}, relay::kAllWatchers})
    rig.say(*rig.spectators[0], to, forger.say(0.9));
  rig.run(0.2);
  EXPECT_EQ(rig.count(relay::Result::kWatcher), 3u);
  EXPECT_TRUE(rig.first.heard.empty());
  EXPECT_TRUE(rig.spectators[1]->heard.empty());
}

TEST(WatchByRelay, ASpectatorWhoseIdIsTakenTakesAnother) {
  WatchRig rig;
  auto& third = rig.joinAt(VirtualNet::addressOf(30), 30, 17, "lab", rig.kKey, true);
  rig.run(1.0);
  ASSERT_TRUE(third.member->isIdTaken());
  third.member->callAs(PeerId{40});
  rig.run(2.0);
  EXPECT_TRUE(third.member->isIn());
}

}  // namespace
}  // namespace tandem
