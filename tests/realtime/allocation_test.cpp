// Site::tick allocates nothing, and the counter that checks this can count.

#include <cstdlib>
#include <iostream>
#include <memory>

#include <gtest/gtest.h>

#include <LinearMath/btAlignedAllocator.h>

#include "tandem/plugin/recording.h"

#include "demos/program/scenario/scenario.h"
#include "demos/program/world/scene.h"
#include "realtime/allocation_count.h"
#include "support/checkout.h"

namespace tandem::demos {
namespace {

using test::AllocationCount;

// Runs before main, and so before the first Bullet object.
const bool bullet_is_watched = (AllocationCount::watchBullet(), true);

/// Exposes a pointer to the compiler, so that it cannot omit the allocation.
const volatile void* volatile shown = nullptr;
void use(const volatile void* memory) { shown = memory; }

template <typename Action>
std::size_t countIn(Action action) {
  const AllocationCount count(false);
  action();
  return count.count();
}

struct alignas(64) Wide {
  double values[8] = {};
};

TEST(AllocationCount, SeesEveryDoorToTheHeap) {
  ASSERT_TRUE(bullet_is_watched);
  EXPECT_EQ(countIn([] {}), 0u);
  EXPECT_EQ(countIn([] { use(std::make_unique<int>(1).get()); }), 1u);
  EXPECT_EQ(countIn([] { use(std::make_unique<int[]>(9).get()); }), 1u);
  EXPECT_EQ(countIn([] { use(std::unique_ptr<int>(new (std::nothrow) int(1)).get()); }), 1u);
  EXPECT_EQ(countIn([] { use(std::make_unique<Wide>().get()); }), 1u);
  EXPECT_EQ(countIn([] { use(std::vector<double>(100).data()); }), 1u);
  EXPECT_EQ(countIn([] { use(Eigen::VectorXd(20).data()); }), 1u);
  EXPECT_EQ(countIn([] {
              void* memory = std::malloc(10);
              use(memory);
              std::free(memory);
            }),
            1u);
  EXPECT_EQ(countIn([] {
              void* memory = btAlignedAlloc(100, 16);
              use(memory);
              btAlignedFree(memory);
            }),
            1u);
  EXPECT_GE(countIn([] { use(std::make_unique<btSphereShape>(btScalar(1)).get()); }), 1u);
}

TEST(AllocationCount, SeesBulletsOwnLibrary) {
  // Bullet's shared library allocates its pools by its own allocator.
  EXPECT_GE(countIn([] { btDefaultCollisionConfiguration configuration; }), 3u);
}

struct Case {
  const char* name;
  const char* scenario;
  std::vector<std::string> overrides;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

class Tick : public ::testing::TestWithParam<Case> {};

TEST_P(Tick, DoesNotAllocateAfterWarmUp) {
  constexpr std::uint64_t kWarmUp = 200, kTicks = 10'000;
  const Scenario scenario = loadScenario(test::inCheckout("demos/scenarios/") + GetParam().scenario,
                                         GetParam().overrides);
  auto [end1, end2] = makeSimulatedLinks(scenario.network);
  SiteWorld world1(scenario, 0, *end1), world2(scenario, 1, *end2);
  SiteWorld* const worlds[] = {&world1, &world2};
  Recording recording(kWarmUp + kTicks, 4 * kTicks, world1.site().objectCount(),
                      world1.site().proxyBody(0) ? 1 : 0);
  world1.site().record(&recording);

  std::size_t in_ticks = 0, in_host_steps = 0;
  std::uint32_t status = kTickOk;
  for (std::uint64_t tick = 0; tick < kWarmUp + kTicks; ++tick) {
    const double now = static_cast<double>(tick) / scenario.site.haptic_rate;
    for (SiteWorld* world : worlds) {
      const AllocationCount count(tick >= kWarmUp);
      status |= world->site().tick(now);
      if (tick >= kWarmUp) in_ticks += count.count();
    }
    for (SiteWorld* world : worlds) {
      const AllocationCount count(false);
      world->stepHostUntil(static_cast<double>(tick + 1) / scenario.site.haptic_rate);
      if (tick >= kWarmUp) in_host_steps += count.count();
    }
    ASSERT_EQ(status, kTickOk) << "tick " << tick;
    ASSERT_EQ(in_ticks, 0u) << "tick " << tick;
  }
  const SiteCounters& counters = world1.site().counters();
  const double sent = static_cast<double>(world2.site().counters().packets_sent);
  EXPECT_GT(sent, 200.0);
  EXPECT_GT(static_cast<double>(counters.packets_taken + counters.packets_stale),
            0.75 * (1.0 - scenario.network.loss) * sent);
  EXPECT_EQ(recording.leftOut(), 0u);
  // The host's own steps may allocate; the number is recorded for information.
  RecordProperty("allocations_in_host_steps", static_cast<int>(in_host_steps));
  std::cout << "allocations in the host's steps: " << in_host_steps << '\n';
}

/// Users hold on to waypoints and push a cube on a floor forth and back, off its middle.
const std::vector<std::string> kFloor = {
    "experiment.guide=false",
    "world.floor=true",
    "world.gravity=9.81",
    "site1.hand=minimum_jerk",
    "site1.hand_waypoints=[[0,0,0,0],[0.1,0,0,0],[1,0.05,0.004,0.002],[3,0,0,0],[5,0.04,-0.003,0],"
    "[8,0,0,0]]",
    "site2.hand=minimum_jerk",
    "site2.hand_waypoints=[[0,0,0,0],[4,0,0,0],[6,-0.06,0,0.003]]"};

std::vector<Case> makeCases() {
  std::vector<Case> cases;
  for (const auto& [name, file] :
       {std::pair{"Cooperation", "experiment1.toml"}, {"UserContact", "experiment2.toml"}}) {
    cases.push_back({name, file, {"experiment.scheme=remote_dynamic_proxy"}});
    cases.push_back({name, file, {"experiment.scheme=kinematic_proxy"}});
    cases.push_back({name, file, {"experiment.scheme=virtual_coupling"}});
    cases.push_back({name, file, {"bridge.injection=impulse", "rates.host=1000"}});
    cases.push_back(
        {name, file, {"network.loss=0.1", "network.jitter=0.03", "network.duplicate=0.2"}});
    cases.push_back({name, file, {"experiment.guide=false", "experiment.axis=[0.6,0,0.8]"}});
    // Peers are lost and return all the time.
    cases.push_back({name, file, {"network.loss=0.97"}});
    cases.push_back({name, file, {"network.loss=0.97", "experiment.guide=false"}});
  }
  cases.push_back({"Floor", "experiment1.toml", kFloor});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Tick, ::testing::ValuesIn(makeCases()), [](const auto& test) {
  return test.param.name + std::to_string(test.index);
});

}  // namespace
}  // namespace tandem::demos
