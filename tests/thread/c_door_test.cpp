// Calls the C door from several threads, as its header allows.

#include <atomic>
#include <thread>

#include "c_door/two_meshes.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kStep = 1.0 / 60.0;

/// A host that steps in real time, twice as fast.
template <typename Work>
void runHost(int steps, const LinkedSite& site, Work work) {
  for (int i = 0; i < steps; ++i) {
    ok(tandem_world_step(site.world, kStep, 0, 0.0));
    work();
    usleep(8000);
  }
}

// Two threads set up, step and destroy a site and a world each. Each has its own errors.
TEST(CDoor, SitesOfTwoThreadsShareNothing) {
  const auto run = [](const double* gravity, std::uint64_t& hash) {
    for (int round = 0; round < 20; ++round) {
      TandemLink* link = nullptr;
      ok(tandem_link_create_manual(&link));
      {
        const LinkedSite site(1, link);
        ok(tandem_world_set_gravity(site.world, gravity));
        for (int i = 0; i < 10; ++i) ok(tandem_world_step(site.world, kStep, 0, 0.0));
        EXPECT_EQ(tandem_world_set_gravity(site.world, nullptr), TANDEM_INVALID_ARGUMENT);
        EXPECT_STREQ(tandem_last_error(), "gravity is null; give the address of one");
        hash = site.read().state_hash;
      }
      ok(tandem_link_destroy(link));
    }
  };
  const double down[3] = {0.0, 0.0, -9.81}, none[3] = {0.0, 0.0, 0.0};
  std::uint64_t falls = 0, floats = 0, alone = 0;
  std::thread other([&] { run(down, falls); });
  run(none, floats);
  other.join();
  run(down, alone);
  EXPECT_EQ(falls, alone);
  EXPECT_NE(falls, floats);
}

// The loop's thread ticks while the host steps, moves the hand, reads, and carries packets.
TEST(CDoor, ALoopRunsBesideTheHost) {
  TandemLink* link = nullptr;
  ok(tandem_link_create_manual(&link));
  {
    const LinkedSite site(1, link, TANDEM_TICK_CALLER);
    std::atomic<bool> ends{false};
    std::uint64_t popped = 0;
    ok(tandem_site_start_loop(site.site, 0));
    std::thread carrier([&] {
      TandemPacket packet{};
      int there = 0;
      while (!ends) {
        ok(tandem_link_pop(link, &packet, &there));
        popped += there != 0;
        TandemPacket theirs{};
        theirs.sender = 2;
        theirs.sequence = popped;
        theirs.energy_granted = std::nan("");
        ok(tandem_link_push(link, &theirs));
        usleep(500);
      }
    });
    double x = -0.04;
    runHost(60, site, [&] {
      const double hand[3] = {x += 0.0005, 0.0, 0.0}, speed[3] = {0.03, 0.0, 0.0};
      double force[3];
      ok(tandem_device_move(site.device, hand, speed));
      ok(tandem_device_get_force(site.device, force));
      EXPECT_TRUE(std::isfinite(force[0]));
      EXPECT_TRUE(std::isfinite(site.read().hip[0]));
    });
    EXPECT_EQ(tandem_site_tick(site.site, 100.0, nullptr), TANDEM_IN_USE);
    EXPECT_EQ(tandem_site_share(site.site, site.cube, 0.0, nullptr), TANDEM_CANNOT);
    EXPECT_EQ(tandem_site_start_loop(site.site, 0), TANDEM_CANNOT);
    ends = true;
    carrier.join();
    EXPECT_GT(site.read().ticks, 10u);
    EXPECT_GT(site.read().packets_taken, 0u);
    EXPECT_GT(popped, 0u);
    ok(tandem_site_stop_loop(site.site));
    ok(tandem_site_stop_loop(site.site));
    // The site belongs to the caller again, and may get another loop.
    const std::uint64_t ticks = site.read().ticks;
    ok(tandem_site_tick(site.site, 100.0, nullptr));
    EXPECT_EQ(site.read().ticks, ticks + 1);
    ok(tandem_site_start_loop(site.site, 0));
    // Destroying the site ends the loop.
  }
  ok(tandem_link_destroy(link));
}

TEST(CDoor, ASimulatedLinkIsNotForLoops) {
  const TandemNetwork network{};
  TandemLink *first = nullptr, *second = nullptr;
  ok(tandem_link_create_simulated(&network, &first, &second));
  {
    const LinkedSite site(1, first, TANDEM_TICK_CALLER);
    EXPECT_EQ(tandem_site_start_loop(site.site, 0), TANDEM_CANNOT);
    ok(tandem_site_tick(site.site, 0.0, nullptr));
  }
  ok(tandem_link_destroy(first));
  ok(tandem_link_destroy(second));
}

// Two looped sites use sockets: this thread steps both worlds, another polls both meshes.
TEST(CDoor, LoopsMeetOverAMesh) {
  const TwoMeshes meshes;
  ASSERT_TRUE(meshes.pollUntil([&] { return meshes.areBoth(TANDEM_PEER_LIVE); }));
  TandemLink *to_second = nullptr, *to_first = nullptr;
  ok(tandem_mesh_link(meshes.first, 2, &to_second));
  ok(tandem_mesh_link(meshes.second, 1, &to_first));
  const LinkedSite one(1, to_second, TANDEM_TICK_CALLER), two(2, to_first, TANDEM_TICK_CALLER);
  const TandemState moved = makeState(Vec3(0.0, 0.02, 0.0));
  ok(tandem_world_set_state(one.world, one.cube, &moved));
  ok(tandem_site_start_loop(one.site, 0));
  ok(tandem_site_start_loop(two.site, 0));
  std::atomic<bool> ends{false};
  std::thread network([&] {
    while (!ends) {
      meshes.poll();
      usleep(1000);
    }
  });
  Meeting meeting;
  const double end = readClock() + kPatience;
  bool have_met = false;
  while (!have_met && readClock() < end) {
    for (const LinkedSite* site : {&one, &two}) ok(tandem_world_step(site->world, kStep, 0, 0.0));
    usleep(15000);
    have_met = meeting.look(one, two);
  }
  EXPECT_TRUE(have_met) << meeting.here.position[1] << " " << meeting.there.position[1];
  ends = true;
  network.join();
  EXPECT_GT(two.read().packets_taken, 10u);
  ok(tandem_site_stop_loop(one.site));
  ok(tandem_site_stop_loop(two.site));
}

}  // namespace
}  // namespace tandem
