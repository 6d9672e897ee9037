// Several worlds in several threads with a site each: none affects another.

#include <array>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "host/any_host.h"
#include "host/body_bits.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::AnyHost;
using test::WorldKind;

/// A hand presses a cube into a row of boxes on a floor. Repeats this `rounds` times from the
/// start, each time with a new site.
std::uint64_t simulate(double speed, int rounds) {
  test::BitHash hash;
  for (int round = 0; round < rounds; ++round) {
    AnyHost host(WorldKind::kDiscrete, Vec3(0.0, 0.0, -9.81));
    host.addBody(host.makeBox(Vec3(1.0, 1.0, 0.1)), 0.0, Vec3(0.0, 0.0, -0.12));
    btRigidBody& cube = host.addCube(0.2);
    for (int i = 1; i < 4; ++i) host.addCube(0.1, Vec3(0.045 * i, 0.0, 0.0));
    test::FakeDevice device(Vec3(-0.031, 0.0, 0.0));
    test::FakeLink link;
    Site site({}, *host.world, device);
    site.share(cube);
    site.connect(PeerId{2}, link, Vec3(0.0, 0.04, 0.0));
    for (int i = 0; i < 60; ++i) {
      device.sample.hip.p_W.x() += speed / 120.0;
      link.arrivals.push_back(
          {test::makePacket(PeerId{2}, static_cast<std::uint64_t>(i), Vec3(0.0, 0.04, 0.0)),
           i / 120.0});
      host.world->stepSimulation(btScalar(1) / 120, 4, btScalar(1) / 480);
      for (const auto& body : host.bodies) hash.add(*body);
    }
    hash.add(site.stateHash());
    EXPECT_EQ(site.status(), kTickOk);
  }
  return hash.value();
}

TEST(WorldsInThreads, HaveTheBitsOfOneAfterTheOther) {
  constexpr int kRounds = 3;
  constexpr std::array kSpeeds = {0.05, 0.08};
  std::array<std::uint64_t, 2> serial{}, parallel{};
  for (std::size_t i = 0; i < 2; ++i) serial[i] = simulate(kSpeeds[i], kRounds);
  std::thread other([&] { parallel[1] = simulate(kSpeeds[1], kRounds); });
  parallel[0] = simulate(kSpeeds[0], kRounds);
  other.join();
  EXPECT_NE(serial[0], serial[1]);
  EXPECT_EQ(serial, parallel);
}

}  // namespace
}  // namespace tandem
