// Equal runs have equal hashes, independent of earlier or concurrent runs. So has a run's replay.

#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "demos/program/run/virtual_run.h"
#include "plugin/src/record/replay.h"
#include "support/checkout.h"

namespace tandem::demos {
namespace {

struct Case {
  std::string name;
  std::string file;
  std::vector<std::string> overrides;
};

void PrintTo(const Case& c, std::ostream* stream) { *stream << c.name; }

Scenario load(const Case& c) {
  return loadScenario(test::inCheckout("demos/scenarios/" + c.file), c.overrides);
}

std::uint64_t computeHash(const Scenario& scenario) {
  VirtualRun run(scenario);
  run.run();
  return run.summary().state_hash;
}

/// Loss, jitter, duplicates and reordering.
const std::vector<std::string> kBadNetwork = {"network.loss=0.1", "network.jitter=0.02",
                                              "network.duplicate=0.1", "network.reorder=0.1",
                                              "network.seed=41"};

/// Both experiments, all schemes, both injections, guide on and off, good and bad network.
std::vector<Case> makeCases() {
  std::vector<Case> cases;
  const auto add = [&](std::string name, const std::string& file,
                       std::vector<std::string> overrides, const std::vector<std::string>& more) {
    overrides.insert(overrides.end(), more.begin(), more.end());
    cases.push_back({std::move(name), file, std::move(overrides)});
  };
  for (const auto& [title, file] :
       {std::pair<std::string, std::string>{"Cooperation", "experiment1.toml"},
        {"Users", "experiment2.toml"}}) {
    for (const char* scheme : {"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"}) {
      const std::string name = title + "_" + scheme;
      // Half a second includes contact, packets and, off the slot, the start of the buckling.
      const std::vector<std::string> base = {std::string("experiment.scheme=") + scheme,
                                             "experiment.duration=0.5"};
      const std::vector<std::string> impulse = {"bridge.injection=impulse", "rates.host=1000"};
      const std::vector<std::string> free = {
          "experiment.guide=false", "experiment.axis=[0.6,0,0.8]", "site1.hand_force=[3,0.2,0.1]"};
      std::vector<std::string> free_impulse = free;
      free_impulse.insert(free_impulse.end(), impulse.begin(), impulse.end());
      add(name + "_handoff", file, base, {});
      add(name + "_impulse", file, base, impulse);
      add(name + "_free_handoff", file, base, free);
      add(name + "_free_impulse", file, base, free_impulse);
      add(name + "_bad_network", file, base, kBadNetwork);
    }
  }
  cases.push_back(
      {"Floor",
       "experiment1.toml",
       {"experiment.guide=false", "world.floor=true", "world.gravity=9.81",
        "world.boxes=[[0.1,0,0,0.04,0.1]]", "experiment.duration=0.5", "site1.hand=minimum_jerk",
        "site1.hand_waypoints=[[0,0,0,0],[0.4,0.05,0.004,0.002]]", "site2.hand=minimum_jerk",
        "site2.hand_waypoints=[[0,0,0,0]]"}});
  for (const std::string four : {"experiment1_many.toml", "experiment2_many.toml"}) {
    add("Four_" + four.substr(0, 11), four, {"experiment.duration=0.5"}, {});
    add("Four_" + four.substr(0, 11) + "_bad_network", four, {"experiment.duration=0.5"},
        kBadNetwork);
  }
  return cases;
}

class Determinism : public ::testing::TestWithParam<Case> {};

TEST_P(Determinism, EqualRunsHaveEqualHashes) {
  const Scenario scenario = load(GetParam());
  const std::uint64_t hash = computeHash(scenario);
  EXPECT_EQ(computeHash(scenario), hash);
}

/// Ticks one site of a recorded run again, alone.
std::uint64_t replay(const Scenario& scenario, VirtualRun& run, int site) {
  const Recording& recording = run.recording(site);
  ReplayDevice device(recording, run.world(site).device().capabilities());
  std::vector<std::unique_ptr<ReplayLink>> links;
  std::vector<Link*> to_peers;
  for (int remote = 0; remote < run.siteCount() - 1; ++remote) {
    links.push_back(std::make_unique<ReplayLink>(recording, remote));
    to_peers.push_back(links.back().get());
  }
  SiteWorld world(scenario, site, PeerLinks(to_peers), device);
  for (std::size_t tick = 0; tick < recording.ticks().size(); ++tick) {
    world.site().tick(static_cast<double>(tick) / scenario.site.haptic_rate);
    world.stepHostUntil(static_cast<double>(tick + 1) / scenario.site.haptic_rate);
  }
  return world.site().stateHash();
}

TEST_P(Determinism, ReplayHasTheHashOfTheRun) {
  const Scenario scenario = load(GetParam());
  VirtualRun run(scenario);
  run.run();
  for (int site = 0; site < run.siteCount(); ++site) {
    ASSERT_EQ(run.recording(site).leftOut(), 0u);
    EXPECT_EQ(replay(scenario, run, site), run.world(site).site().stateHash())
        << "site " << site + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(Runs, Determinism, ::testing::ValuesIn(makeCases()),
                         [](const auto& test) { return test.param.name; });

TEST(DeterminismOfRuns, NothingIsLeftBehindByOtherRuns) {
  std::vector<std::uint64_t> first, again;
  const std::vector<Case> cases = makeCases();
  for (std::size_t i = 0; i < cases.size(); i += 3) first.push_back(computeHash(load(cases[i])));
  // Runs in another order, so that each has other predecessors.
  for (std::size_t i = first.size(); i-- > 0;)
    again.insert(again.begin(), computeHash(load(cases[3 * i])));
  EXPECT_EQ(first, again);
}

TEST(DeterminismOfRuns, RunsBesideEachOtherDoNotMeet) {
  const Scenario a = load({"", "experiment1.toml", {"experiment.duration=0.3"}});
  const Scenario b = load({"", "experiment2.toml", {"experiment.duration=0.3"}});
  VirtualRun outer(a);
  std::uint64_t inner = 0;
  outer.run([&](double) { inner = computeHash(b); });
  EXPECT_EQ(outer.summary().state_hash, computeHash(a));
  EXPECT_EQ(inner, computeHash(b));
}

TEST(DeterminismOfRuns, AnotherSeedIsAnotherRun) {
  std::set<std::uint64_t> hashes;
  for (int seed = 0; seed < 5; ++seed) {
    Case c{"", "experiment1.toml", kBadNetwork};
    c.overrides.push_back("network.seed=" + std::to_string(seed));
    hashes.insert(computeHash(load(c)));
  }
  EXPECT_EQ(hashes.size(), 5u);
}

TEST(DeterminismOfRuns, SeedMeansNothingToAGoodNetwork) {
  EXPECT_EQ(computeHash(load({"", "experiment1.toml", {"network.seed=1"}})),
            computeHash(load({"", "experiment1.toml", {"network.seed=2"}})));
}

TEST(DeterminismOfRuns, EverySchemeHasItsOwnHash) {
  std::set<std::uint64_t> hashes;
  for (const char* scheme : {"virtual_coupling", "kinematic_proxy", "remote_dynamic_proxy"})
    hashes.insert(
        computeHash(load({"", "experiment1.toml", {std::string("experiment.scheme=") + scheme}})));
  EXPECT_EQ(hashes.size(), 3u);
}

TEST(Replay, KnowsTheDevicesForceLimit) {
  const Scenario scenario = load({"", "experiment1.toml", {"device.max_force=3"}});
  VirtualRun run(scenario);
  run.run();
  ASSERT_DOUBLE_EQ(run.summary().sites[0].force_max, 3.0);
  EXPECT_EQ(replay(scenario, run, 0), run.world(0).site().stateHash());
}

// A packet that arrives at once belongs to the tick after the sending one. A replay must respect
// this.
TEST(Replay, HoldsWithoutDelay) {
  for (const char* network : {"network.delay=0", "network.reorder=0.5"}) {
    const Scenario scenario = load({"", "experiment1.toml", {network, "network.rate=1000"}});
    VirtualRun run(scenario);
    run.run();
    for (int site = 0; site < 2; ++site)
      EXPECT_EQ(replay(scenario, run, site), run.world(site).site().stateHash())
          << network << ", site " << site + 1;
  }
}

}  // namespace
}  // namespace tandem::demos
