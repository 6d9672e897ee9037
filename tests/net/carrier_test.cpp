// The mesh by a carrier that is a queue in memory: handshakes and states as by UDP.

#include <algorithm>
#include <deque>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tandem/plugin/datagram_carrier.h"
#include "tandem/plugin/udp_mesh.h"

#include "net/virtual_net.h"

namespace tandem {
namespace {

/// One end of a bus of two sites.
class QueueCarrier final : public DatagramCarrier {
 public:
  QueueCarrier(PeerId self, std::deque<test::Bytes>& out, std::deque<test::Bytes>& in)
      : other_(PeerId{3 - static_cast<std::uint32_t>(self)}), out_(out), in_(in) {}
  void send(ByteView datagram, PeerId to) noexcept override {
    if (to == other_) out_.push_back({datagram.data, datagram.data + datagram.size});
  }
  std::optional<Received> receive(ByteSpan room) noexcept override {
    if (in_.empty()) return std::nullopt;
    const test::Bytes bytes = in_.front();
    in_.pop_front();
    std::copy_n(bytes.begin(), std::min(bytes.size(), room.size), room.data);
    return Received{bytes.size(), other_};
  }
  void wait(double) const noexcept override {}

 private:
  PeerId other_;
  std::deque<test::Bytes>& out_;
  std::deque<test::Bytes>& in_;
};

/// Two sites on one bus, in virtual time.
struct Carried {
  static UdpMeshSettings settings(PeerId self, DatagramCarrier& carrier) {
    UdpMeshSettings settings;
    settings.self = self;
    settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
    settings.carrier = &carrier;
    return settings;
  }
  static std::vector<UdpPeer> peer(unsigned id) {
    std::vector<UdpPeer> peers;
    peers.push_back({PeerId{id}, std::nullopt, test::makeKey(7)});
    return peers;
  }
  void poll(int times) {
    for (int i = 0; i < times; ++i) {
      now += 1e-3;
      first.poll(now);
      second.poll(now);
    }
  }
  [[nodiscard]] bool areLive() const {
    return first.status(PeerId{2}, now).phase == PeerPhase::kLive &&
           second.status(PeerId{1}, now).phase == PeerPhase::kLive;
  }

  double now = 0.0;  // [s]
  std::deque<test::Bytes> to_second, to_first;
  QueueCarrier at_first{PeerId{1}, to_second, to_first};
  QueueCarrier at_second{PeerId{2}, to_first, to_second};
  UdpMesh first{settings(PeerId{1}, at_first), peer(2)};
  UdpMesh second{settings(PeerId{2}, at_second), peer(1)};
};

TEST(Carrier, ConnectsWithoutAnAddress) {
  Carried two;
  two.poll(3000);
  EXPECT_TRUE(two.areLive());
  EXPECT_FALSE(two.first.status(PeerId{2}, two.now).address);
}

TEST(Carrier, DeliversStates) {
  Carried two;
  two.poll(3000);
  ASSERT_TRUE(two.areLive());
  StatePacket packet;
  packet.user.p_W = Vec3(0.25, 0, 0);
  two.first.link(PeerId{2}).send(packet, two.now);
  std::optional<Arrival> arrival;
  for (int i = 0; i < 100 && !arrival; ++i) {
    two.poll(1);
    arrival = two.second.link(PeerId{1}).receive(two.now, two.now + 1e-3);
  }
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->packet.user.p_W, Vec3(0.25, 0, 0));
}

// What a carrier delivers may be anything: each datagram is refused and counted, and the pair stays
// live.
TEST(Carrier, ItsBytesAreNotTrusted) {
  Carried two;
  two.poll(3000);
  ASSERT_TRUE(two.areLive());
  for (const std::size_t size : {0u, 1u, 19u, 160u, 1200u, 1201u, 9000u})
    two.to_second.push_back(test::Bytes(size, 0xff));
  const std::uint64_t before = two.second.received();
  two.poll(50);
  std::uint64_t refused = 0;
  for (const RefusedDatagrams& one : two.second.refused()) refused += one.count;
  EXPECT_GE(two.second.received() - before, 7u);
  EXPECT_EQ(refused, 7u);
  EXPECT_TRUE(two.areLive());
}

TEST(Carrier, TakesNoRelay) {
  std::deque<test::Bytes> out, in;
  QueueCarrier carrier(PeerId{1}, out, in);
  RelayAccess relay{resolveAddress("127.0.0.1:7000"), test::makeKey(9), "lab"};
  EXPECT_THROW(UdpMesh(Carried::settings(PeerId{1}, carrier), Carried::peer(2), std::move(relay)),
               std::invalid_argument);
}

}  // namespace
}  // namespace tandem
