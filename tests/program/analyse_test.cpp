// `tandem analyse`: verdicts, borders, exit status, refusals.

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::expectLine;
using test::Outcome;
using test::runTandem;
using Words = std::vector<std::string>;

Words line(const std::string& file, const Words& more = {}) {
  Words all = {"analyse", test::scenarioPath(file)};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

nlohmann::json analyse(const std::string& file, Words more = {}) {
  more.push_back("--json");
  const Outcome outcome = runTandem(line(file, more));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

TEST(Analyse, TellsModesAndBordersOfThePapersGains) {
  const auto coupled = analyse("experiment1.toml", {"--set", "experiment.scheme=virtual_coupling"});
  EXPECT_TRUE(coupled["stable"].get<bool>());
  EXPECT_EQ(coupled["modes"][1]["name"], "difference");
  EXPECT_NEAR(coupled["modes"][1]["rate"].get<double>(), -0.583, 1e-3);
  EXPECT_NEAR(coupled["modes"][1]["frequency"].get<double>(), 46.5, 0.1);
  const auto& stiffness = coupled["gains"][0];
  EXPECT_EQ(stiffness["key"], "coordination.stiffness");
  EXPECT_TRUE(stiffness["down"].is_null());
  EXPECT_NEAR(stiffness["up"].get<double>(), 389.451, 0.01);
  EXPECT_NEAR(coupled["largest_coordination_stiffness"].get<double>(), 389.451, 0.01);

  const auto proxy = analyse("experiment1.toml");
  EXPECT_FALSE(proxy["stable"].get<bool>());
  EXPECT_NEAR(proxy["modes"][1]["rate"].get<double>(), 1.912, 1e-3);
  EXPECT_NEAR(proxy["modes"][1]["held_rate"].get<double>(), -0.134, 1e-3);
  EXPECT_EQ(proxy["remedy"]["key"], "device.damping");
  EXPECT_LT(proxy["remedy"]["rate"].get<double>(), 0.0);
}

TEST(Analyse, ManyUsersNeedTheAverage) {
  const Words held = {
      "--set", "experiment.scheme=virtual_coupling", "--set", "network.delay=0.02", "--users", "4"};
  Words average = held;
  average.insert(average.end(), {"--set", "coordination.mode=average"});
  const auto worst = [](const nlohmann::json& a) {
    return std::max(a["modes"][0]["held_rate"].get<double>(),
                    a["modes"][1]["held_rate"].get<double>());
  };
  EXPECT_GT(worst(analyse("experiment1.toml", held)), 0.0);
  EXPECT_LT(worst(analyse("experiment1.toml", average)), -2.0);
}

TEST(Analyse, SaysInWordsWhatToTurn) {
  const Outcome outcome = runTandem(line("experiment1.toml"));
  EXPECT_EQ(outcome.status, 0);
  for (const char* words : {"against each other", "Unstable with lasting contact", "doubles in",
                            "Hands that hold their devices", "device.damping = 2.8"})
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << '\n' << outcome.out;
}

// A run tells it before it begins, but not to scripts.
TEST(Analyse, ARunWarnsOfGrowth) {
  const auto run = [](const Words& more) {
    Words all = {"run", test::scenarioPath("experiment1.toml"), "--set", "experiment.duration=0.1"};
    all.insert(all.end(), more.begin(), more.end());
    return runTandem(all);
  };
  const std::string note = "note: with lasting contact and empty hands, motion against each other";
  EXPECT_EQ(run({}).out.rfind(note, 0), 0u);
  EXPECT_EQ(run({"--quiet"}).out, "");
  EXPECT_EQ(run({"--json"}).out.front(), '{');
  EXPECT_EQ(run({"--set", "device.damping=3"}).out.find("note"), std::string::npos);
}

TEST(Analyse, AnyPacketRateIsTakenAsOneWithAPeriod) {
  const auto odd = analyse("experiment1.toml", {"--set", "network.rate=127.3219"});
  EXPECT_NEAR(odd["packet_rate"].get<double>(), 127.3219, 1e-3);
  EXPECT_NE(odd["packet_rate"].get<double>(), 127.3219);
  EXPECT_NEAR(odd["modes"][1]["rate"].get<double>(), 1.9, 0.5);
  EXPECT_EQ(analyse("experiment1.toml")["packet_rate"], 128.0);
  const Outcome words = runTandem(line("experiment1.toml", {"--set", "network.rate=127.3219"}));
  EXPECT_NE(words.out.find("network.rate = 127.3219 is taken as"), std::string::npos);
}

TEST(Analyse, TakesUsersWhoDiffer) {
  const auto heavy = analyse("experiment1.toml", {"--set", "site2.device_mass=0.3"});
  EXPECT_EQ(heavy["modes"][0]["name"], "any");
  ASSERT_EQ(heavy["modes"][0]["users"].size(), 2u);
  EXPECT_EQ(heavy["gains"].size(), 6u);
  const Outcome words = runTandem(line("experiment1.toml", {"--set", "site2.device_mass=0.3"}));
  EXPECT_NE(words.out.find("In it move: user 1"), std::string::npos) << words.out;
}

TEST(Analyse, TellsWhetherContactLasts) {
  const auto wall = analyse("experiment2.toml", {"--set", "experiment.scheme=kinematic_proxy"});
  EXPECT_NEAR(wall["contact"]["restitution"].get<double>(), 0.946, 1e-3);
  EXPECT_TRUE(wall["contact"]["comes_and_goes"].get<bool>());
  EXPECT_TRUE(analyse("experiment1.toml")["contact"].is_null());
}

TEST(Analyse, WorstPhaseMayDecide) {
  const Words near_border = {"--check", "--set", "experiment.scheme=virtual_coupling", "--set",
                             "coordination.stiffness=375"};
  Words at_worst = near_border;
  at_worst.push_back("--worst-phase");
  EXPECT_EQ(runTandem(line("experiment1.toml", near_border)).status, 0);
  EXPECT_EQ(runTandem(line("experiment1.toml", at_worst)).status, 3);
}

TEST(Analyse, GainsMayBeLeftToTheDelay) {
  const auto chosen = analyse("experiment1.toml", {"--set", "coordination=auto"});
  EXPECT_TRUE(chosen["stable"].get<bool>());
  EXPECT_NEAR(chosen["gains"][0]["value"].get<double>(), 74.0, 8.0);
  const auto damped = analyse("experiment1.toml",
                              {"--set", "experiment.scheme=virtual_coupling", "--set",
                               "coordination.damping=auto", "--set", "coordination.stiffness=100"});
  EXPECT_EQ(damped["gains"][0]["value"], 100.0);
  EXPECT_TRUE(damped["stable"].get<bool>());
  const Outcome run = runTandem({"run", test::scenarioPath("experiment1.toml"), "--set",
                                 "coordination=auto", "--set", "experiment.duration=0.1"});
  EXPECT_EQ(run.out.rfind("note: coordination for 50 ms: stiffness", 0), 0u) << run.out;
  EXPECT_EQ(run.out.find("doubles"), std::string::npos);
}

TEST(Analyse, OnlyACheckFails) {
  EXPECT_EQ(runTandem(line("experiment1.toml", {"--check"})).status, 3);
  EXPECT_EQ(runTandem(line("experiment1.toml",
                           {"--check", "--set", "experiment.scheme=virtual_coupling"}))
                .status,
            0);
}

TEST(Analyse, RefusesByALine) {
  const auto with = [](const Words& more) { return runTandem(line("experiment1.toml", more)); };
  expectLine(with({"--set", "network.delay=0.6"}), 2, "delay");
  expectLine(with({"--set", "network.rate=0.3"}), 2, "no period of at most 2000 ticks");
  expectLine(with({"--set", "site2.device_mass=0.3", "--users", "3"}), 2, "--users: the scenario");
  expectLine(with({"--set", "coordination=200"}), 2, "\"auto\", or a table");
  expectLine(with({"--set", "coordination.damping=autos"}), 2, "a finite number, or \"auto\"");
  expectLine(runTandem(line("playground.toml", {"--set", "coordination=auto"})), 2,
             "coordination = \"auto\": experiment.kind");
  expectLine(with({"--set", "contact.model=native_rigid"}), 2, "contact.model");
  expectLine(runTandem(line("playground.toml")), 2, "three dimensions");
  expectLine(with({"--users", "1"}), 2, "--users 1: must be 2 to 64");
}

}  // namespace
}  // namespace tandem
