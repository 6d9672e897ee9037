// The carrier on Cyclone DDS, restricted to loopback, in a domain chosen by the process.

#include "dds/dds_carrier.h"

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "tandem/plugin/udp_mesh.h"

#include "dds/dds_pair.h"
#include "net/virtual_net.h"

namespace tandem {
namespace {

using test::clockNow;
using test::DdsPair;
using test::kPatience;

// With a history of one, a handshake or a state would replace the datagram before it.
TEST(DdsCarrier, ABurstArrivesWhole) {
  DdsPair two;
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
  DdsPair two;
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

// What Cyclone would print becomes a part of the error's one line.
TEST(DdsCarrier, SaysWhatCycloneRefuses) {
  const int domain = test::openLoopbackDomain();
  setenv("CYCLONEDDS_URI",
         "<General><Interfaces><NetworkInterface name='none0'/></Interfaces></General>", 1);
  testing::internal::CaptureStderr();
  try {
    DdsCarrier(domain, PeerId{1}, {PeerId{2}});
    ADD_FAILURE() << "opened a domain on an interface that is not there";
  } catch (const Error& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("none0: does not match an available interface; look"), std::string::npos)
        << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
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
  DdsPair two;
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
