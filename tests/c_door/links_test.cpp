// Packets that the caller transports.

#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kStep = 1.0 / 60.0;

TEST(ManualLink, CarriesWhatASiteSends) {
  const LoneDoorProxy site(makeWorld());
  const double hand[3] = {1.0, 2.0, 3.0}, speed[3] = {0.0, 0.0, 0.0};
  ok(tandem_device_move(site.device, hand, speed));
  ok(tandem_world_step(site.world, 1.0, 0, 0.0));
  TandemPacket packet{};
  int there = 0;
  std::uint64_t count = 0;
  for (;; ++count) {
    ok(tandem_link_pop(site.link, &packet, &there));
    if (!there) break;
    EXPECT_EQ(packet.sender, 1u);
    EXPECT_EQ(packet.sequence, count);
    EXPECT_EQ(packet.position[2], 3.0);
    EXPECT_EQ(packet.object_count, 0u);
  }
  EXPECT_EQ(count, site.read().packets_sent);
  EXPECT_GT(count, 20u);
}

TEST(ManualLink, BringsStatesOfObjects) {
  FreeDoorCube site(makeWorld());
  ok(tandem_site_connect(site.site, 2, site.link, kFarAway, nullptr));
  TandemPacket packet{};
  packet.sender = 2;
  packet.energy_granted = std::nan("");
  packet.object_count = 1;
  packet.objects[0] = makeState(Vec3(0.5, 0.0, 0.0));
  ok(tandem_link_push(site.link, &packet));
  ok(tandem_world_step(site.world, kStep, 0, 0.0));
  EXPECT_EQ(site.read().packets_taken, 1u);
  EXPECT_EQ(site.read().status, 0u);
}

TEST(ManualLink, NonsenseIsCountedByTheSite) {
  const LoneDoorProxy site(makeWorld());
  TandemPacket packet{};
  packet.sender = 2;
  packet.sequence = 1;
  packet.position[0] = std::nan("");
  ok(tandem_link_push(site.link, &packet));
  ok(tandem_world_step(site.world, kStep, 0, 0.0));
  EXPECT_EQ(site.read().packets_taken, 1u);  // the packet from its set-up
  EXPECT_EQ(site.read().status, std::uint32_t{TANDEM_STATUS_PACKET_REFUSED});
}

TEST(ManualLink, HoldsSomePacketsAndLosesTheRest) {
  TandemLink* link = nullptr;
  ok(tandem_link_create_manual(&link));
  TandemPacket packet{};
  for (int i = 0; i < 1000; ++i) ok(tandem_link_push(link, &packet));
  int there = 7;
  TandemPacket untouched{};
  untouched.sequence = 99;
  ok(tandem_link_pop(link, &untouched, &there));
  EXPECT_EQ(there, 0);
  EXPECT_EQ(untouched.sequence, 99u);
  ok(tandem_link_destroy(link));
}

TEST(SimulatedLink, EitherEndMayGoFirst) {
  for (const bool first_goes : {false, true}) {
    const TandemNetwork network{};
    TandemLink *first = nullptr, *second = nullptr;
    ok(tandem_link_create_simulated(&network, &first, &second));
    ok(tandem_link_destroy(first_goes ? first : second));
    ok(tandem_link_destroy(first_goes ? second : first));
  }
}

}  // namespace
}  // namespace tandem
