// A spectator over real sockets.

#include "tandem/plugin/watcher.h"

#include <gtest/gtest.h>

#include "tandem/plugin/relay.h"

#include "net/virtual_net.h"

namespace tandem {
namespace {

using test::makeKey;

RelayAccess accessTo(const RelayServer& relay, bool has_watch_key = true) {
  RelayAccess access{resolveAddress("127.0.0.1:" + std::to_string(relay.bound().port)),
                     makeKey(0x17), "lab"};
  if (has_watch_key) access.watch_key = makeKey(0x55);
  return access;
}

TEST(Watcher, NeedsAWatchKey) {
  RelayServer relay({resolveAddress("127.0.0.1:0")}, makeKey(0x17));
  EXPECT_THROW(Watcher(accessTo(relay, false)), std::invalid_argument);
}

TEST(Watcher, FollowsASiteWhosePeerIsNotThere) {
  RelayServer relay({resolveAddress("127.0.0.1:0")}, makeKey(0x17));
  UdpMeshSettings settings;
  settings.bind = resolveAddress("127.0.0.1:0");
  settings.watch_hash = 77;
  std::vector<UdpPeer> peers;
  peers.push_back({PeerId{2}, std::nullopt, makeKey(1)});
  UdpMesh site(settings, std::move(peers), accessTo(relay));
  Watcher watchers[2] = {Watcher(accessTo(relay), settings.bind),
                         Watcher(accessTo(relay), settings.bind)};
  const auto seen = [&] { return watchers[0].latest(PeerId{1}) && watchers[1].latest(PeerId{1}); };

  StatePacket packet;
  packet.sender = PeerId{1};
  packet.user.p_W = {0.25, 0.0, 0.0};
  double now = 0.0;
  for (int step = 0; step < 20000 && !seen(); ++step, now += 1e-3) {
    relay.poll(now);
    site.poll(now);
    site.link(PeerId{2}).send(packet, now);
    ++packet.sequence;
    for (Watcher& one : watchers) one.poll(now);
  }

  ASSERT_TRUE(seen());
  for (const Watcher& one : watchers) {
    EXPECT_EQ(one.latest(PeerId{1})->newest.user.p_W.x(), 0.25);
    EXPECT_EQ(one.latest(PeerId{1})->config_hash, 77u);
    EXPECT_EQ(one.heard(), std::vector{PeerId{1}});
    EXPECT_TRUE(one.relay(now).is_in);
    EXPECT_TRUE(one.refused().empty());
  }
}

}  // namespace
}  // namespace tandem
