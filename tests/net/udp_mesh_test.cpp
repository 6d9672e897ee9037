// The mesh over real sockets on loopback. No test asserts times; each waits as long as a loaded
// machine may need.

#include "tandem/plugin/udp_mesh.h"

#include <chrono>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/udp_socket.h"

#include "net/virtual_net.h"

namespace tandem {
namespace {

constexpr double kPatience = 30.0;  // [s]

Address loopback(std::uint16_t port = 0) {
  Address address = resolveAddress("127.0.0.1:0");
  address.port = port;
  return address;
}

double clockNow() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Two meshes of this process. Site 1 knows the address of site 2, which waits for the call.
struct Two {
  Two() {
    std::vector<UdpPeer> known;
    known.push_back({PeerId{1}, std::nullopt, test::makeKey(7)});
    UdpMeshSettings settings;
    settings.self = PeerId{2};
    settings.bind = loopback();
    settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
    second = std::make_unique<UdpMesh>(settings, std::move(known));
    settings.self = PeerId{1};
    std::vector<UdpPeer> peers;
    peers.push_back({PeerId{2}, loopback(second->bound().port), test::makeKey(7)});
    first = std::make_unique<UdpMesh>(settings, std::move(peers));
  }
  void poll() {
    first->poll(clockNow());
    second->poll(clockNow());
    first->wait(1e-3);
  }
  [[nodiscard]] bool areLive() const {
    return first->status(PeerId{2}, clockNow()).phase == PeerPhase::kLive &&
           second->status(PeerId{1}, clockNow()).phase == PeerPhase::kLive;
  }
  template <typename Done>
  [[nodiscard]] bool pollUntil(Done done) {
    const double end = clockNow() + kPatience;
    while (clockNow() < end && !done()) poll();
    return done();
  }

  std::unique_ptr<UdpMesh> first, second;
};

TEST(UdpMesh, CarriesStatesBothWays) {
  Two two;
  ASSERT_TRUE(two.pollUntil([&] { return two.areLive(); }));
  std::uint64_t sent = 0;
  std::optional<Arrival> at_first, at_second;
  EXPECT_TRUE(two.pollUntil([&] {
    StatePacket packet;
    packet.sequence = sent++;
    packet.time = 0.5;
    packet.user.p_W = Vec3(0.25, 0, 0);
    two.first->link(PeerId{2}).send(packet, clockNow());
    two.second->link(PeerId{1}).send(packet, clockNow());
    const double now = clockNow();
    if (!at_first) at_first = two.first->link(PeerId{2}).receive(now, now + 1e-3);
    if (!at_second) at_second = two.second->link(PeerId{1}).receive(now, now + 1e-3);
    return at_first && at_second;
  }));
  EXPECT_EQ(at_first->packet.sender, PeerId{2});
  EXPECT_EQ(at_second->packet.sender, PeerId{1});
  EXPECT_EQ(at_second->packet.user.p_W, Vec3(0.25, 0, 0));
  EXPECT_EQ(at_second->packet.time, 0.5);
}

TEST(UdpMesh, FarewellIsTold) {
  Two two;
  ASSERT_TRUE(two.pollUntil([&] { return two.areLive(); }));
  two.first->leave(clockNow());
  EXPECT_TRUE(two.pollUntil(
      [&] { return two.second->status(PeerId{1}, clockNow()).phase == PeerPhase::kLeft; }));
}

TEST(UdpMesh, DrainsAFloodBitByBit) {
  Two two;
  ASSERT_TRUE(two.pollUntil([&] { return two.areLive(); }));
  net::UdpSocket stranger(loopback());
  std::array<std::uint8_t, 172> junk{};
  const std::uint64_t before = two.second->received();
  for (int i = 0; i < 500; ++i)
    stranger.send({junk.data(), junk.size()}, loopback(two.second->bound().port));
  two.second->poll(clockNow());
  EXPECT_LE(two.second->received() - before, 128u);
  EXPECT_TRUE(two.pollUntil([&] {
    for (const RefusedDatagrams& one : two.second->refused())
      if (one.reason == "form: magic") return one.count > 64;
    return false;
  }));
  EXPECT_TRUE(two.areLive());
}

TEST(UdpSocket, IsNotBoundTwice) {
  const net::UdpSocket first(loopback());
  try {
    const net::UdpSocket second(loopback(first.bound().port));
    FAIL() << "bound twice";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("another port"), std::string::npos) << error.what();
  }
}

TEST(UdpSocket, RefusesAnAddressOfAnotherMachine) {
  EXPECT_THROW(net::UdpSocket(resolveAddress("192.0.2.1:0")), std::invalid_argument);
}

TEST(UdpSocket, CarriesIpv4AndIpv6) {
  for (const char* text : {"127.0.0.1:0", "[::1]:0"}) {
    SCOPED_TRACE(text);
    std::unique_ptr<net::UdpSocket> one, other;
    try {
      one = std::make_unique<net::UdpSocket>(resolveAddress(text));
      other = std::make_unique<net::UdpSocket>(resolveAddress(text));
    } catch (const std::exception&) {
      GTEST_SKIP() << "this machine has no " << text;
    }
    const std::array<std::uint8_t, 3> bytes = {1, 2, 3};
    one->send({bytes.data(), bytes.size()}, other->bound());
    other->wait(kPatience);
    std::array<std::uint8_t, 16> room{};
    const auto received = other->receive({room.data(), room.size()});
    ASSERT_TRUE(received);
    EXPECT_EQ(received->size, 3u);
    EXPECT_EQ(received->from, one->bound());
    EXPECT_FALSE(other->receive({room.data(), room.size()}));
  }
}

TEST(Address, IsWrittenAsItIsRead) {
  for (const char* text : {"127.0.0.1:7001", "[::1]:7001", "[2001:db8::5]:1", "10.1.2.3:65535"})
    EXPECT_EQ(toString(resolveAddress(text)), text);
  EXPECT_EQ(toString(resolveAddress(":7001")), "[::]:7001");
}

TEST(Address, RefusesWhatIsNone) {
  for (const char* text : {"", "host", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000",
                           "::1:7001", "[::1:7001", "256.0.0.1:7001", "127.0.0.1:-1"})
    EXPECT_THROW((void)resolveAddress(text), std::invalid_argument) << text;
}

}  // namespace
}  // namespace tandem
