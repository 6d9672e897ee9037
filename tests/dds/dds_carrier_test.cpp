// The carrier on Cyclone DDS, restricted to loopback, in a domain chosen by the process.

#include "dds/dds_carrier.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tandem/plugin/udp_mesh.h"

#include "net/virtual_net.h"

namespace tandem {
namespace {

constexpr double kPatience = 30.0;  // [s]

double clockNow() {
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int openDomain() {
  setenv("CYCLONEDDS_URI",
         "<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface name='lo'/>"
         "</Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<Peers><Peer address='localhost'/></Peers></Discovery>",
         1);
  return 100 + static_cast<int>(getpid()) % 100;
}

struct Two {
  const int domain = openDomain();
  DdsCarrier first{domain, PeerId{1}, {PeerId{2}}};
  DdsCarrier second{domain, PeerId{2}, {PeerId{1}}};
};

/// Sends until the sites have found each other, then takes what is left of that.
void meet(Two& two) {
  std::array<std::uint8_t, 1500> room{};
  const double end = clockNow() + kPatience;
  bool has_met = false;
  while (!has_met && clockNow() < end) {
    two.first.send({room.data(), 8}, PeerId{2});
    two.second.wait(1e-3);
    has_met = two.second.receive({room.data(), room.size()}).has_value();
  }
  ASSERT_TRUE(has_met);
  two.second.wait(0.05);
  while (two.second.receive({room.data(), room.size()})) two.second.wait(0.05);
}

// With a history of one, a handshake or a state would replace the datagram before it.
TEST(DdsCarrier, ABurstArrivesWhole) {
  Two two;
  meet(two);
  std::array<std::uint8_t, 1500> room{};
  for (std::uint8_t i = 0; i < 32; ++i) {
    room[0] = i;
    two.first.send({room.data(), 100u + i}, PeerId{2});
  }
  for (std::uint8_t i = 0; i < 32; ++i) {
    two.second.wait(kPatience);
    const auto received = two.second.receive({room.data(), room.size()});
    ASSERT_TRUE(received) << int(i);
    EXPECT_EQ(received->size, 100u + i);
    EXPECT_EQ(received->from, PeerId{1});
    EXPECT_EQ(room[0], i);
  }
}

TEST(DdsCarrier, CutsWhatHasNoRoom) {
  Two two;
  meet(two);
  std::array<std::uint8_t, 1200> bytes{};
  two.first.send({bytes.data(), bytes.size()}, PeerId{2});
  two.second.wait(kPatience);
  const auto received = two.second.receive({bytes.data(), 10});
  ASSERT_TRUE(received);
  EXPECT_EQ(received->size, 10u);
}

TEST(DdsCarrier, RefusesADomainWithoutPorts) {
  EXPECT_THROW(DdsCarrier(-1, PeerId{1}, {PeerId{2}}), std::invalid_argument);
  EXPECT_THROW(DdsCarrier(233, PeerId{1}, {PeerId{2}}), std::invalid_argument);
}

UdpMesh makeMesh(PeerId self, DatagramCarrier& carrier) {
  UdpMeshSettings settings;
  settings.self = self;
  settings.configuration = makeConfiguration({{"object.mass", "0.2"}});
  settings.carrier = &carrier;
  std::vector<UdpPeer> peers;
  peers.push_back({PeerId{3 - static_cast<std::uint32_t>(self)}, std::nullopt, test::makeKey(7)});
  return UdpMesh(settings, std::move(peers));
}

TEST(DdsCarrier, CarriesSealedStates) {
  Two two;
  UdpMesh first = makeMesh(PeerId{1}, two.first), second = makeMesh(PeerId{2}, two.second);
  std::optional<Arrival> arrival;
  StatePacket packet;
  packet.user.p_W = Vec3(0.25, 0, 0);
  for (const double end = clockNow() + kPatience; !arrival && clockNow() < end;) {
    first.poll(clockNow());
    second.poll(clockNow());
    first.link(PeerId{2}).send(packet, clockNow());
    ++packet.sequence;
    arrival = second.link(PeerId{1}).receive(clockNow(), clockNow() + 1e-3);
    second.wait(1e-3);
  }
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->packet.user.p_W, Vec3(0.25, 0, 0));
}

}  // namespace
}  // namespace tandem
