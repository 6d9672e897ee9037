// Runs with more than two sites: links, couplers to all others, and what the summary says of them.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "demos/program/run/run_output.h"
#include "demos/program/scenario/scenario.h"
#include "demos/program/world/received_object.h"
#include "program/tandem_program.h"
#include "support/temp_folder.h"

namespace tandem::demos {
namespace {

using Words = std::vector<std::string>;

Scenario load(const std::string& file, const Words& overrides) {
  return loadScenario(test::scenarioPath(file), overrides);
}

/// A finished run with its summary.
struct Finished {
  Scenario scenario;
  VirtualRun run{scenario};
  nlohmann::json summary;
  Finished(const std::string& file, const Words& overrides) : scenario(load(file, overrides)) {
    run.run();
    summary = makeSummary(scenario, run);
  }
};

TEST(ManySitesRun, TwoListedSitesAreTheTwoThatHadNumbers) {
  const Words short_run = {"experiment.duration=0.3", "network.loss=0.2", "network.jitter=0.01"};
  Words listed = short_run;
  listed.insert(listed.begin(), "site=[{hand_force=[5, 0, 0]}, {}]");
  const Finished a("experiment1.toml", short_run), b("experiment1.toml", listed);
  EXPECT_EQ(a.summary["state_hash"], b.summary["state_hash"]);
  EXPECT_FALSE(a.summary.contains("drag"));
}

// Each of the N - 1 couplers of a copy pulls back by K v tau; its target is as old as the delay and
// half a packet period. Hands squeeze the cube, so that contact lasts, and push by 1 N each.
TEST(ManySitesRun, TheDragOfCommonMotionIsThatOfTheDelay) {
  const Finished finished(
      "experiment1.toml",
      {"site=[{hand_force=[4, 0, 0]}, {hand_force=[-2, 0, 0]}, {hand_force=[4, 0, 0]}, "
       "{hand_force=[-2, 0, 0]}]",
       "experiment.scheme=virtual_coupling", "object.mass=0.4", "device.damping=5",
       "experiment.duration=3"});
  const double age = finished.scenario.network.delay + 0.5 / finished.scenario.site.packet_rate;
  const double drag = 3.0 * finished.scenario.site.coordination.stiffness * age;
  const nlohmann::json& measured = finished.summary["drag"];
  EXPECT_NEAR(measured["per_speed"].get<double>(), drag, 0.01 * drag);
  // The hands' forces go into the drag and the devices' own damping.
  EXPECT_NEAR(measured["force"].get<double>() + 5.0 * measured["speed"].get<double>(), 1.0, 0.01);
}

// The third user is there for a second. Before and after, the two share the cube by halves.
TEST(ManySitesRun, UsersComeAndGo) {
  Finished finished(
      "experiment1.toml",
      {"site=[{hand_force=[2, 0, 0]}, {hand_force=[-2, 0, 0]}, {comes=1, goes=2}]",
       "coordination.mode=average", "coordination.follows_users=true", "experiment.duration=3"});
  const auto site = [&](int s) -> Site& { return finished.run.world(s).site(); };
  for (const int s : {0, 1}) {
    EXPECT_EQ(site(s).memberCount(), 2);
    EXPECT_EQ(site(s).counters().members_changed, 3u);
    EXPECT_EQ(site(s).status(), kTickOk);
    const double mass = 1.0 / static_cast<double>(site(s).objectBody(0).getInvMass());
    EXPECT_NEAR(mass, finished.scenario.object_mass / 2.0, 1e-6);
  }
  EXPECT_EQ(site(2).memberCount(), 1);
  EXPECT_EQ(site(2).counters().members_changed, 2u);
}

// The live programs show this distance; users 1 and 3 have different delays to user 2.
TEST(ManySitesRun, TheFarthestCopyIsThatOfTheOtherSites) {
  VirtualRun run(load("experiment1.toml", {"site=[{hand_force=[5, 0, 0]}, {}, {}]",
                                           "site3.delay=0.1", "experiment.duration=0.5"}));
  const Site& site = run.world(1).site();
  EXPECT_FALSE(findFarthestCopy(site));
  run.run();
  const Vec3 own_W = site.object(0).p_W;
  double distances[2];
  for (int remote : {0, 1})
    distances[remote] = (findObject(site.latest(remote), 0)->p_W - own_W).norm();
  EXPECT_GT(std::abs(distances[0] - distances[1]), 1e-4);
  const auto farthest = findFarthestCopy(site);
  ASSERT_TRUE(farthest);
  EXPECT_EQ((farthest->p_W - own_W).norm(), std::max(distances[0], distances[1]));
}

TEST(ManySitesRun, CoherencyIsThatOfTheFarthestPair) {
  const Finished finished("experiment1.toml", {"site=[{hand_force=[5, 0, 0]}, {}, {}]",
                                               "site2.delay=0.1", "experiment.duration=0.5"});
  const nlohmann::json& coherency = finished.summary["coherency"];
  ASSERT_EQ(coherency["pairs"].size(), 3u);
  double largest = 0.0, largest_mean = 0.0;
  for (const nlohmann::json& pair : coherency["pairs"]) {
    EXPECT_LT(pair["i"], pair["j"]);
    largest = std::max(largest, pair["max"].get<double>());
    largest_mean = std::max(largest_mean, pair["mean"].get<double>());
  }
  EXPECT_EQ(coherency["max_abs"].get<double>(), largest);
  EXPECT_GE(coherency["mean_abs"].get<double>(), largest_mean);
  EXPECT_GT(largest, 1e-3);
}

// In a row each user feels the neighbours, and nobody beyond.
TEST(ManySitesRun, UsersInARowFeelTheirNeighbours) {
  const Finished finished("experiment2.toml",
                          {"site=[{hand_force=[3, 0, 0]}, {}, {hand_force=[-3, 0, 0]}]"});
  const nlohmann::json& contacts = finished.summary["contacts"];
  for (const auto& [own, other] :
       {std::pair("site1", "site2"), {"site2", "site1"}, {"site2", "site3"}, {"site3", "site2"}})
    EXPECT_GT(contacts[own][other].get<double>(), 0.1) << own << " feels " << other;
  EXPECT_EQ(contacts["site1"]["site3"], 0.0);
  EXPECT_EQ(contacts["site3"]["site1"], 0.0);
  for (const char* site : {"site1", "site2", "site3"}) EXPECT_EQ(contacts[site]["object"], 0.0);
}

// Users side by side push one cube, and do not feel each other.
TEST(ManySitesRun, UsersAtOneFaceFeelTheObjectAlone) {
  const Finished finished(
      "experiment1.toml",
      {"site=[{hand_force=[3, 0, 0]}, {}, {hand_force=[3, 0, 0]}, {}]", "experiment.duration=0.5"});
  for (const char* site : {"site1", "site3"}) {
    EXPECT_GT(finished.summary["contacts"][site]["object"].get<double>(), 0.9);
    for (const auto& [other, share] : finished.summary["contacts"][site].items()) {
      if (other == "object") continue;
      EXPECT_EQ(share, 0.0) << site << " feels " << other;
    }
  }
  EXPECT_NEAR(finished.summary["site1"]["device_end"].get<double>(),
              finished.summary["site3"]["device_end"].get<double>(), 1e-9);
}

TEST(ManySitesRun, EachWayHasItsOwnDelay) {
  const Finished finished("experiment1.toml",
                          {"site=[{}, {}, {}]", "experiment.duration=0.3",
                           "network.delays=[[0, 0.01, 0.02], [0.03, 0, 0.04], [0.05, 0.06, 0]]"});
  for (int to = 0; to < 3; ++to) {
    std::vector<double> first(3, -1.0);
    for (const ArrivalRecord& record : finished.run.recording(to).arrivals()) {
      const auto from = static_cast<std::size_t>(record.arrival.packet.sender) - 1;
      if (first[from] < 0.0) first[from] = record.arrival.time - record.arrival.packet.time;
    }
    first[static_cast<std::size_t>(to)] = 0.0;  // it hears nothing of itself
    for (std::size_t from = 0; from < 3; ++from)
      EXPECT_NEAR(first[from], finished.scenario.delays[from][static_cast<std::size_t>(to)], 1e-9)
          << from << " to " << to;
  }
}

TEST(ManySitesRun, PairsLosePacketsApart) {
  const Finished finished("experiment1.toml", {"site=[{}, {}, {}]", "experiment.duration=1",
                                               "network.loss=0.5", "network.seed=3"});
  std::vector<std::vector<std::uint64_t>> heard(3);  // by site 1, from each
  for (const ArrivalRecord& record : finished.run.recording(0).arrivals())
    heard[static_cast<std::size_t>(record.arrival.packet.sender) - 1].push_back(
        record.arrival.packet.sequence);
  EXPECT_GT(heard[1].size(), 30u);
  EXPECT_GT(heard[2].size(), 30u);
  EXPECT_NE(heard[1], heard[2]);
}

TEST(ManySitesRun, ASiteMayHaveItsOwnDeviceAndContact) {
  const Words all = {"site=[{hand_force=[3, 0, 0]}, {hand_force=[3, 0, 0]}, {}]",
                     "experiment.kind=user_contact", "experiment.duration=0.1",
                     "experiment.scheme=virtual_coupling"};
  Words own = all;
  own.insert(own.end(), {"site1.device_mass=0.4", "site1.device_damping=0"});
  const Finished finished("experiment2.toml", own);
  EXPECT_NEAR(finished.summary["site1"]["device_end"].get<double>(), 0.5 * 3.0 / 0.4 * 0.01, 1e-9);
  Words soft = {"site=[{hand_force=[3, 0, 0]}, {}, {}]", "site1.contact_stiffness=400",
                "experiment.duration=0.2"};
  const Finished yielding("experiment1.toml", soft);
  const TickRecord& last = yielding.run.recording(0).ticks().back();
  const double depth =
      (last.device.hip.p_W - yielding.run.recording(0).ticks()[0].device.hip.p_W -
       yielding.run.recording(0).object(yielding.run.recording(0).ticks().size() - 1, 0).island.p_W)
          .x();
  EXPECT_NEAR(-last.f_W.x(), 400.0 * depth, 0.2);
  EXPECT_GT(depth, 5e-3);
}

// A folder's older result of more sites leaves nothing behind.
TEST(ManySitesRun, ARunOfFewerSitesReplacesOneOfMore) {
  const test::TempFolder folder;
  for (const char* sites : {"site=[{}, {}, {}, {}]", "site=[{}, {}, {}]"}) {
    const Finished finished("experiment1.toml", {sites, "experiment.duration=0.05"});
    const OutputFolder output(folder.path(), "--out");
    writeRun(output, finished.summary, finished.run);
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "site3.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "site4.csv"));
}

}  // namespace
}  // namespace tandem::demos
