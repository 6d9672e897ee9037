// `tandem relay` and sites that meet through it, as processes on loopback.

#include <algorithm>
#include <csignal>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/relay_rig.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::expectLine;
using test::Outcome;
using test::RelayRig;
using test::runTandem;

TEST(RelayProgram, TwoSitesMeetThroughItWithoutAddresses) {
  RelayRig rig({"--json"});
  const std::string key = rig.folder / "relay";
  auto second = std::async(std::launch::async, [&] {
    return runTandem(rig.site(2, {"--relay-key", key, "--out", rig.folder / "two"}));
  });
  const Outcome first = runTandem(rig.site(1, {"--relay-key", key, "--out", rig.folder / "one"}));
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(second.get().status, 0);
  EXPECT_NE(first.out.find("by the relay"), std::string::npos) << first.out;
  const auto summary = nlohmann::json::parse(test::readFile(rig.folder / "one/site1.json"));
  EXPECT_GT(summary["network"]["states"]["given"], 50);
  const Outcome end = rig.relay->finish(SIGTERM);
  EXPECT_EQ(end.status, 0);
  const auto report = nlohmann::json::parse(end.out.substr(0, end.out.find('\n')));
  EXPECT_TRUE(report.contains("rooms"));
}

// It has no site and no pair's key, and the sites do not wait for it.
TEST(RelayProgram, ASpectatorFollowsBothSites) {
  RelayRig rig;
  const std::string key = rig.folder / "relay", watch = rig.folder / "watch";
  ASSERT_EQ(runTandem({"key", "new", watch}).status, 0);
  auto spectator = std::async(std::launch::async, [&] {
    return runTandem({"peer", "--watch", "--relay", rig.address, "--relay-key", key, "--watch-key",
                      watch, "--wait", "4", "--out", rig.folder / "seen"});
  });
  auto second = std::async(std::launch::async, [&] {
    return runTandem(rig.site(2, {"--relay-key", key, "--watch-key", watch}));
  });
  EXPECT_EQ(runTandem(rig.site(1, {"--relay-key", key, "--watch-key", watch})).status, 0);
  EXPECT_EQ(second.get().status, 0);
  const Outcome outcome = spectator.get();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto columns = test::readColumns(rig.folder / "seen/watch.csv");
  const std::vector<double>& sites = columns.at("site");
  for (const double site : {1.0, 2.0}) EXPECT_GT(std::ranges::count(sites, site), 10) << site;
}

/// A spectator's line with the files of the rig.
std::vector<std::string> watchLine(RelayRig& rig, const std::string& watch_key,
                                   const std::vector<std::string>& more) {
  std::vector<std::string> line = {"peer",        "--watch",     "--relay",
                                   rig.address,   "--relay-key", rig.folder / "relay",
                                   "--watch-key", watch_key};
  line.insert(line.end(), more.begin(), more.end());
  return line;
}

/// Both sites of experiment1.toml, seen by spectators with the key `watch`.
void runWatchedSites(RelayRig& rig, const std::string& watch) {
  const std::vector<std::string> more = {
      "--relay-key", rig.folder / "relay", "--watch-key", watch, "--set", "contact.stiffness=2000"};
  auto second = std::async(std::launch::async, [&] { return runTandem(rig.site(2, more)); });
  EXPECT_EQ(runTandem(rig.site(1, more)).status, 0);
  EXPECT_EQ(second.get().status, 0);
}

// Scheme, gains and users may change while sites meet, so they are not compared.
TEST(RelayProgram, ASpectatorsScenarioIsComparedWithThatOfTheSites) {
  RelayRig rig;
  const std::string watch = rig.folder / "watch", file = test::scenarioPath("experiment1.toml");
  ASSERT_EQ(runTandem({"key", "new", watch}).status, 0);
  const auto follow = [&](const std::vector<std::string>& more) {
    return std::async(std::launch::async,
                      [line = watchLine(rig, watch, more)] { return runTandem(line); });
  };
  auto fits = follow({"--scenario", file, "--wait", "4"});
  auto differs = follow({"--scenario", file, "--set", "object.size=0.05"});
  runWatchedSites(rig, watch);
  EXPECT_EQ(fits.get().status, 0);
  expectLine(differs.get(), 2, "has another scenario; use the file and --set that the sites have");
}

TEST(RelayProgram, AWrongWatchKeyIsALine) {
  RelayRig rig;
  const std::string watch = rig.folder / "watch";
  ASSERT_EQ(runTandem({"key", "new", watch}).status, 0);
  auto spectator = std::async(std::launch::async,
                              [&] { return runTandem(watchLine(rig, rig.folder / "pair", {})); });
  runWatchedSites(rig, watch);
  expectLine(spectator.get(), 1, "--watch-key opens no state of this room");
}

TEST(RelayProgram, ASpectatorThatHearsNobodySaysWhy) {
  RelayRig rig;
  const std::string key = rig.folder / "pair";
  expectLine(runTandem(watchLine(rig, key, {"--wait", "1"})), 1,
             "no site was heard for 1 s: do the sites have --watch-key and this room?");
  EXPECT_EQ(rig.relay->finish(SIGINT).status, 0);
  expectLine(runTandem(watchLine(rig, key, {"--wait", "1"})), 1, "the relay does not answer");
}

TEST(RelayProgram, ASpectatorsBadInputIsALine) {
  expectLine(runTandem({"peer", "--watch"}), 2,
             "--watch needs --relay, --relay-key and --watch-key");
  expectLine(runTandem({"peer", "--watch", "--site", "1"}), 2, "has no site and no hand");
  expectLine(runTandem({"peer", "--watch", "--set", "title=a"}), 2, "--set: needs --scenario");
  expectLine(runTandem({"peer", "--site", "1"}), 2, "--scenario is required");
}

TEST(RelayProgram, AWrongKeyIsALine) {
  RelayRig rig;
  const Outcome outcome =
      runTandem(rig.site(1, {"--relay-key", rig.folder / "pair", "--wait", "2"}));
  expectLine(outcome, 1, "the relay has another key");
}

TEST(RelayProgram, ARelayThatIsNotThereIsALine) {
  RelayRig rig;
  const std::string key = rig.folder / "relay";
  EXPECT_EQ(rig.relay->finish(SIGINT).status, 0);
  expectLine(runTandem(rig.site(1, {"--relay-key", key, "--wait", "1"})), 1,
             "the relay does not answer");
}

TEST(RelayProgram, BadUseIsALine) {
  RelayRig rig;
  const std::string key = rig.folder / "relay";
  const auto relay = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line = {"relay", "--bind", test::ownLoopback() + ":0", "--key", key};
    line.insert(line.end(), more.begin(), more.end());
    return runTandem(line);
  };
  expectLine(relay({"--members", "65"}), 2, "members = 65: must be 2 to 64");
  expectLine(relay({"--rooms", "0"}), 2, "rooms = 0: must be 1 to 10000");
  expectLine(relay({"--rate", "0"}), 2, "datagram_rate");
  expectLine(relay({"--seconds", "-1"}), 2, "--seconds -1: must be 0 to 1e9");
  expectLine(runTandem({"relay", "--bind", rig.address, "--key", key}), 2, "in use");
  expectLine(runTandem(rig.site(1, {})), 2, "--relay-key");
  expectLine(runTandem(rig.site(1, {"--relay-key", key, "--room", "a b"})), 2, "room a b: must be");
  EXPECT_EQ(relay({"--seconds", "0"}).status, 0);
}

}  // namespace
}  // namespace tandem
