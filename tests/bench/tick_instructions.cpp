// Fixed scenes whose ticks scripts/instructions.sh counts in instructions:
//
//   tandem_tick_instructions about          prints the compiler and its options
//   tandem_tick_instructions SCENE TICKS    runs the scene; calls measureTick() TICKS times
//   tandem_tick_instructions host BODIES AWAKE SHARED SITE STEPS
//                                           the same for a host's steps in which nothing is touched
//                                           (AWAKE, SITE: 0 or 1; without a site the world is bare)

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "bench/scenes/island_chain.h"
#include "bench/speed/speed_site.h"
#include "demos/program/scenario/scenario.h"
#include "demos/program/world/scene.h"
#include "support/checkout.h"

using namespace tandem::demos;

/// The script finds this function by name; all other code is not counted.
extern "C" [[gnu::noinline]] void measureTick(const std::function<void()>& tick) { tick(); }

namespace {

constexpr int kWarmUp = 3000;  // ticks: caches fill, bodies that can sleep do

void runIsland(bench::IslandChain chain, int ticks) {
  for (int i = 0; i < kWarmUp; ++i) chain.tick();
  for (int i = 0; i < ticks; ++i) measureTick([&] { chain.tick(); });
}

/// Ticks of a site in a world with a sleeping neighbourhood. The host's steps are not counted.
void runSite(const bench::SpeedScene& scene, int ticks) {
  bench::SpeedSite site(scene);
  int host_steps = 0;
  for (int i = 0; i < kWarmUp + ticks; ++i) {
    if (i < kWarmUp)
      site.tick();
    else
      measureTick([&] { site.tick(); });
    if ((i + 1) * bench::SpeedSite::kHostRate < (host_steps + 1) * bench::SpeedSite::kHapticRate)
      continue;
    site.stepHost();
    ++host_steps;
  }
}

/// Steps of a host in which nothing is touched, with a site or bare. Its ticks are not counted.
void runHost(const bench::SpeedScene& scene, bool has_site, int steps) {
  constexpr int kSettle = 60;  // host steps
  const auto run = [&](auto& step, auto& before) {
    for (int i = 0; i < kSettle + steps; ++i) {
      before(i + 1);
      if (i < kSettle)
        step();
      else
        measureTick(step);
    }
  };
  if (!has_site) {
    bench::SpeedWorld world(scene, 1.0);
    world.addProxy(bench::remoteAt(scene, 0.0).p_W, false);
    const auto step = [&] { world.step(1.0 / bench::SpeedSite::kHostRate); };
    const auto nothing = [](int) {};
    return run(step, nothing);
  }
  bench::SpeedSite site(scene);
  const auto step = [&] { site.stepHost(); };
  const auto tick = [&](int i) { (void)site.tickUntil(i / bench::SpeedSite::kHostRate); };
  run(step, tick);
}

/// Site 1 of Experiment II, in its slot.
void runExperiment2(int ticks) {
  const Scenario scenario =
      loadScenario(tandem::test::inCheckout("demos/scenarios/experiment2.toml"), {});
  auto [end1, end2] = tandem::makeSimulatedLinks(scenario.network);
  SiteWorld world1(scenario, 0, *end1), world2(scenario, 1, *end2);
  for (int i = 0; i < kWarmUp + ticks; ++i) {
    const double now = i / scenario.site.haptic_rate;
    const auto tick = [&] { world1.site().tick(now); };
    if (i < kWarmUp)
      tick();
    else
      measureTick(tick);
    world2.site().tick(now);
    for (SiteWorld* world : {&world1, &world2})
      world->stepHostUntil((i + 1) / scenario.site.haptic_rate);
  }
}

const std::map<std::string, std::function<void(int)>> kScenes = {
    {"lone_couplers", [](int ticks) { runIsland(bench::makeLoneCouplers(), ticks); }},
    {"contact_3d", [](int ticks) { runIsland(bench::makeThreeInContact(), ticks); }},
    {"experiment2", runExperiment2},
    {"cube_on_floor",
     [](int ticks) {
       runSite({10, false, 1, bench::SpeedTouch::kOnFloor}, ticks);
     }},
    {"cube_in_space",
     [](int ticks) {
       runSite({10, false, 1, bench::SpeedTouch::kCube}, ticks);
     }},
    {"asleep",
     [](int ticks) {
       runSite({10, false, 1, bench::SpeedTouch::kNothing}, ticks);
     }},
    {"asleep_64_objects", [](int ticks) {
       runSite({10, false, 64, bench::SpeedTouch::kNothing}, ticks);
     }}};

}  // namespace

int main(int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "about") {
    std::printf("%s %s, %s\n", TANDEM_COMPILER, TANDEM_FLAGS, TANDEM_PROCESSOR);
    return 0;
  }
  if (word == "scenes") {
    for (const auto& [name, run] : kScenes) std::printf("%s\n", name.c_str());
    return 0;
  }
  if (argc == 7 && word == "host") {
    const bench::SpeedScene own{std::atoi(argv[2]), std::atoi(argv[3]) != 0, std::atoi(argv[4]),
                                bench::SpeedTouch::kNothing};
    runHost(own, std::atoi(argv[5]) != 0, std::atoi(argv[6]));
    return 0;
  }
  const auto scene = kScenes.find(word);
  const int ticks = argc > 2 ? std::atoi(argv[2]) : 0;
  if (scene == kScenes.end() || ticks <= 0) {
    std::fprintf(stderr, "usage: tandem_tick_instructions about | scenes | SCENE TICKS\n");
    return 2;
  }
  scene->second(ticks);
  return 0;
}
