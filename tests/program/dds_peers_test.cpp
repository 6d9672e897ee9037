// `tandem peer --carrier dds` as processes on loopback. Only properties that hold on any machine
// are asserted; DdsFeel compares the carriers in virtual time.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dds/loopback_domain.h"
#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::expectLine;
using test::Outcome;
using test::runTandem;
using test::TempFolder;
using Words = std::vector<std::string>;

/// Users who share a key, on the bus of this process.
struct Bus {
  explicit Bus(const Words& scenario = {test::scenarioPath("experiment1.toml")}) : task(scenario) {
    EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0);
  }

  [[nodiscard]] Words site(int number, const Words& more = {}) const {
    Words line = {"peer",       "--site", std::to_string(number),    "--key",
                  folder / "k", "--set",  "experiment.duration=0.5", "--scenario"};
    line.insert(line.end(), task.begin(), task.end());
    line.insert(line.end(), more.begin(), more.end());
    line.insert(line.end(), {"--carrier", carrier});
    return line;
  }
  [[nodiscard]] std::vector<Outcome> runAll(int count) const {
    std::vector<Words> lines;
    for (int number = 1; number <= count; ++number) lines.push_back(site(number, {"--out", out}));
    return test::runAtOnce(lines);
  }
  [[nodiscard]] nlohmann::json summaryOf(int number) const {
    return nlohmann::json::parse(test::readFile(out + "/site" + std::to_string(number) + ".json"));
  }

  const Words task;  ///< a scenario and its changes
  TempFolder folder;
  const std::string out = folder / "out";
  const std::string carrier = "dds:" + std::to_string(test::openLoopbackDomain());
};

TEST(DdsPeers, TwoProcessesCooperateWithoutAddresses) {
  const Bus bus;
  const auto outcomes = bus.runAll(2);
  for (const Outcome& outcome : outcomes) ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcomes[0].out.find("site 1 on " + bus.carrier), std::string::npos) << outcomes[0].out;
  const auto first = bus.summaryOf(1), second = bus.summaryOf(2);
  EXPECT_GT(first["site1"]["force"]["mean"].get<double>(), 1.0);
  EXPECT_LT(second["site2"]["coherency"]["received_mean"].get<double>(), 0.1);
  for (const auto& summary : {first, second}) {
    EXPECT_GT(summary["network"]["states"]["given"].get<int>(), 0);
    EXPECT_EQ(summary["network"]["datagrams"]["refused"].value("forged", 0), 0);
  }
}

TEST(DdsPeers, ThreeProcessesCooperateWithoutAddresses) {
  const Bus bus({test::scenarioPath("experiment1_many.toml"), "--set",
                 "site=[{hand_force=[5,0,0]},{},{}]", "--set", "coordination.mode=average"});
  const auto outcomes = bus.runAll(3);
  for (const Outcome& outcome : outcomes) {
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("2 of 2 live"), std::string::npos) << outcome.out;
  }
  for (const int number : {1, 2, 3})
    for (const int other : {1, 2, 3}) {
      const auto network = bus.summaryOf(number)["network"];
      const std::string name = "site" + std::to_string(other);
      EXPECT_TRUE(other == number || network[name]["states"]["given"] > 0) << number << other;
    }
}

TEST(DdsPeers, BadInputIsALine) {
  const Bus bus;
  const auto with = [&](const Words& more) { return runTandem(bus.site(1, more)); };
  expectLine(with({"--bind", ":7001"}), 2,
             "has no addresses; leave out --bind, --peer and --relay");
  expectLine(with({"--peer", "host:7002"}), 2, "has no addresses");
  Words line = bus.site(1);
  for (const std::string word : {"tcp", "dds:", "dds:x", "dds:-1", "dds:233", "dds:7x"}) {
    line.back() = word;
    expectLine(runTandem(line), 2, "--carrier " + word + ": must be dds or dds:DOMAIN");
  }
  expectLine(runTandem({"peer", "--watch", "--carrier", "dds"}), 2, "leave out");
}

TEST(DdsPeers, NobodyOnTheBusIsNamed) {
  const Bus bus;
  expectLine(runTandem(bus.site(1, {"--wait", "0.5"})), 1,
             "site 2 did not join within 0.5 s: is it running, does it know the way here");
}

}  // namespace
}  // namespace tandem
