// Functions that the header calls real-time safe allocate nothing, and in the host's steps the door
// allocates nothing. This program's operator new is counted, Bullet's own allocator is not.

#include <atomic>
#include <cstdlib>
#include <new>

#include "c_door/c_door_rig.h"

namespace {
std::atomic<std::uint64_t> allocations{0};

void* allocate(std::size_t size, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (!memory) throw std::bad_alloc();
  return memory;
}
}  // namespace

// Inlined, they would look to the compiler like mismatched calls.
void* operator new(std::size_t size) { return allocate(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace tandem {
namespace {

using namespace test;

constexpr double kStep = 1.0 / 60.0;

/// Results are checked afterwards, as the test framework allocates.
struct Results {
  TandemResult worst = TANDEM_OK;
  void operator()(TandemResult result) { worst = result == TANDEM_OK ? worst : result; }
};

TEST(Allocations, AreSeen) {
  const std::uint64_t before = allocations;
  const std::string text(100, 'x');
  EXPECT_GT(allocations, before) << text;
}

TEST(Allocations, AreNotOfAStepOfGuests) {
  FreeDoorCube guest(makeWorld());
  ok(tandem_site_connect(guest.site, 2, guest.link, kFarAway, nullptr));
  TandemState now = guest.body(guest.cube), given{};
  TandemPacket packet{};
  packet.sender = 2;
  packet.energy_granted = std::nan("");
  Results all;
  const double speed[3] = {0.1, 0.0, 0.0};
  const auto step = [&] {
    ++packet.sequence;
    int there = 1;
    all(tandem_link_push(guest.link, &packet));
    all(tandem_device_move(guest.device, kFarAway, speed));
    now.velocity[1] += packet.sequence % 2 == 0 ? 0.001 : -0.001;
    all(tandem_world_begin_step(guest.world, kStep, nullptr, 1, &guest.cube, &now, &given));
    now = given;
    for (int i = 0; i < 3; ++i) now.position[i] += kStep * now.velocity[i];
    all(tandem_world_end_step(guest.world, 1, &guest.cube, &now, &now));
    while (there) {
      TandemPacket sent{};
      all(tandem_link_pop(guest.link, &sent, &there));
    }
    all(tandem_world_get_states(guest.world, 1, &guest.cube, &given));
  };
  for (int i = 0; i < 60; ++i) step();
  const std::uint64_t before = allocations;
  for (int i = 0; i < 600; ++i) step();
  // A site allocates now and then for surroundings that it finds.
  EXPECT_LE(allocations, before + 3);
  ok(all.worst);
}

TEST(Allocations, ThereAreNoneInATick) {
  TandemSiteSettings settings = tandem_default_site_settings();
  settings.tick_source = TANDEM_TICK_CALLER;
  const DoorSite site(makeWorld(), settings);
  Results all;
  std::uint64_t ticks = 0;
  const auto tick = [&] {
    double force[3];
    std::uint32_t status = 0;
    all(tandem_device_move(site.device, kFarAway, kNothing));
    all(tandem_site_tick(site.site, 1e-3 * static_cast<double>(++ticks), &status));
    all(tandem_device_get_force(site.device, force));
  };
  for (int i = 0; i < 100; ++i) tick();
  const std::uint64_t before = allocations;
  for (int i = 0; i < 10000; ++i) tick();
  EXPECT_EQ(allocations, before);
  ok(all.worst);
}

}  // namespace
}  // namespace tandem
