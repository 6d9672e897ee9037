// A spectator polls without allocating, whatever the relay brings. Time is passed in.

#include <array>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "tandem/plugin/relay.h"
#include "tandem/plugin/watcher.h"

#include "realtime/allocation_count.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1.0 / 128;  // of states [s]

SecretKey makeKey(std::uint8_t byte) {
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  bytes.fill(byte);
  return SecretKey::take(bytes);
}

/// A site and two spectators in a room, of whom the second has another watch key.
class WatchedRoom {
 public:
  WatchedRoom() : relay_({resolveAddress("127.0.0.1:0")}, makeKey(1)) {
    UdpMeshSettings settings;
    settings.bind = resolveAddress("127.0.0.1:0");
    std::vector<UdpPeer> peers;
    peers.push_back({PeerId{2}, std::nullopt, makeKey(2)});
    site_ = std::make_unique<UdpMesh>(settings, std::move(peers), access(3));
    watcher = std::make_unique<Watcher>(access(3), settings.bind);
    stranger = std::make_unique<Watcher>(access(4), settings.bind);
  }

  void tick() {
    now_ += kPeriod;
    packet_.sender = PeerId{1};
    packet_.time = now_;
    packet_.object_count = 1;
    site_->poll(now_);
    site_->link(PeerId{2}).send(packet_, now_);
    ++packet_.sequence;
    relay_.poll(now_);
    watcher->poll(now_);
    stranger->poll(now_);
  }
  [[nodiscard]] std::uint64_t heard() const {
    const WatchedSite* site = watcher->latest(PeerId{1});
    return site ? site->states : 0;
  }

  std::unique_ptr<Watcher> watcher, stranger;

 private:
  [[nodiscard]] RelayAccess access(std::uint8_t watch_key) const {
    return {resolveAddress("127.0.0.1:" + std::to_string(relay_.bound().port)), makeKey(1), "lab",
            makeKey(watch_key)};
  }

  RelayServer relay_;
  std::unique_ptr<UdpMesh> site_;
  StatePacket packet_;
  double now_ = 0.0;  // [s]
};

TEST(WatcherAllocation, NoneForAPoll) {
  WatchedRoom room;
  for (int i = 0; i < 2000 && (room.heard() < 10 || room.stranger->refused().empty()); ++i)
    room.tick();
  const std::uint64_t heard = room.heard();
  ASSERT_GT(heard, 0u);
  {
    const test::AllocationCount count;
    for (int i = 0; i < 10000; ++i) room.tick();
    EXPECT_EQ(count.count(), 0U);
  }
  // A machine that stands still may lose some on the loopback.
  EXPECT_GT(room.heard(), heard + 2000);
  ASSERT_EQ(room.stranger->refused().size(), 1u);
  EXPECT_EQ(room.stranger->refused()[0].reason, "forged");
}

}  // namespace
}  // namespace tandem
