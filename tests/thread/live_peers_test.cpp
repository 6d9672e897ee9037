// Two whole live sites: for each a haptic thread, the socket's thread and a host's thread.

#include "tandem/plugin/live_peers.h"

#include <array>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/falcon/monotonic_clock.h"

#include "thread/live_rig.h"

namespace tandem {
namespace {

constexpr double kPatience = 30.0;  // [s], for a loaded machine

std::unique_ptr<LivePeers> makePeers(std::uint32_t self, std::optional<Address> address) {
  UdpMeshSettings settings;
  settings.self = PeerId{self};
  settings.bind = resolveAddress("127.0.0.1:0");
  std::array<std::uint8_t, SecretKey::kSize> bytes;
  bytes.fill(7);
  std::vector<UdpPeer> peers;
  peers.push_back({PeerId{3 - self}, address, SecretKey::take(bytes)});
  return std::make_unique<LivePeers>(settings, std::move(peers));
}

// While states go both ways, hosts step and read the status of their peer.
TEST(LivePeersThreads, CarryAnObjectFromSiteToSite) {
  const auto second_peers = makePeers(2, std::nullopt);
  const auto first_peers = makePeers(1, second_peers->bound());
  test::LiveSite first(1, Vec3(0.0, 2.0, 0.0), 1, &first_peers->link(PeerId{2}));
  test::LiveSite second(2, Vec3::Zero(), 1, &second_peers->link(PeerId{1}));
  const auto run = [](test::LiveSite& live, LivePeers& peers, PeerId other) {
    const Vec3 start_W = test::LiveSite::makeSettings(3 - static_cast<int>(other)).start_W;
    peers.agreeOnStart({start_W, Vec3::Zero()}, 128.0);
    peers.startThread();
    const double end = readMonotonicClock() + kPatience;
    while (!peers.start() && readMonotonicClock() < end) sleepFor(1e-3);
    if (!peers.start()) return false;
    HapticLoop loop(*live.site, {.priority = 0, .locks_memory = false, .begin = peers.start()});
    bool has_moved = false;
    while (!has_moved && readMonotonicClock() < end) {
      live.host(0.1);
      has_moved = live.cube->getCenterOfMassPosition().y() > 5e-3;
      (void)peers.status(other, readMonotonicClock());
    }
    live.host(0.5);
    loop.stop();
    peers.sayFarewell();
    return has_moved;
  };
  bool has_second_moved = false;
  std::thread other([&] { has_second_moved = run(second, *second_peers, PeerId{1}); });
  EXPECT_TRUE(run(first, *first_peers, PeerId{2}));
  other.join();
  EXPECT_TRUE(has_second_moved) << "its own hand does not push";
  EXPECT_EQ(first.site->status() | second.site->status(), kTickOk);
  EXPECT_GT(second.site->counters().packets_taken, 10u);
  EXPECT_EQ(first_peers->lost() + second_peers->lost(), 0u);
}

}  // namespace
}  // namespace tandem
