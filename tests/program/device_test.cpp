// `tandem device` with a Falcon emulated byte by byte in its process. No time is asserted.

#include <cmath>
#include <csignal>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/background.h"
#include "program/device_runs.h"
#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using nlohmann::json;
using test::expectRefused;
using test::Outcome;
using test::runEmulated;
using test::runTandem;
using test::TempFolder;
using test::Words;

TEST(Device, ListNamesWhatIsAlwaysThere) {
  const Outcome outcome = runTandem({"device", "list"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("\nemulated "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\nsimulated "), std::string::npos) << outcome.out;
  const json j = json::parse(runTandem({"device", "list", "--json"}).out);
  EXPECT_EQ(j["devices"].size(), j["plugged_in"].get<std::size_t>() + 2);
}

TEST(Device, InfoSaysWhatItCanDo) {
  const Outcome outcome = runEmulated("info", {"--json", "--for", "0.3", "--max-force", "5"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json j = json::parse(outcome.out);
  EXPECT_EQ(j["name"], "Novint Falcon");
  EXPECT_EQ(j["max_force"], 5.0);
  EXPECT_EQ(j["trouble"], "");
  EXPECT_GT(j["counters"]["replies"]["in_this_second"].get<int>(), 0);
  EXPECT_EQ(runEmulated("info", {"--for", "0.1"}).status, 0);
}

TEST(Device, HomeGivesThreeLines) {
  const Outcome outcome = runEmulated("home");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* line : {"1. Pull the grip", "2. Push it in", "homed"})
    EXPECT_NE(outcome.out.find(line), std::string::npos) << outcome.out;
  const Outcome simulated = runTandem({"device", "home", "--device", "simulated"});
  EXPECT_EQ(simulated.status, 0);
  EXPECT_NE(simulated.out.find("nothing to home"), std::string::npos) << simulated.out;
}

// A busy machine may have no time for the driver. The program says so then, and the user repeats.
TEST(Device, CheckMeasuresDirectionAndSize) {
  Outcome outcome = runEmulated("check", {"--json"});
  for (int i = 0; i < 2 && outcome.out.find("readings were missing") != std::string::npos; ++i)
    outcome = runEmulated("check", {"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
  const json pushes = json::parse(outcome.out)["pushes"];
  ASSERT_EQ(pushes.size(), 6U);
  EXPECT_NEAR(pushes[0]["felt"][0].get<double>(), 1.0, 0.1);
  EXPECT_GT(pushes[0]["moved"][0].get<double>(), 0.002);
  EXPECT_LT(pushes[5]["moved"][2].get<double>(), -0.002);
}

// Half the motor counts per torque give half the force.
TEST(Device, CheckFindsAWrongForce) {
  const Outcome outcome = runEmulated("check", {"--motors-per-torque", "2100", "--quiet"});
  EXPECT_EQ(outcome.status, 3) << outcome.out << outcome.err;
}

TEST(Device, LatencyCountsEveryTick) {
  const Outcome outcome = runEmulated("latency", {"--for", "1", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json j = json::parse(outcome.out);
  for (const char* part : {"lateness", "round_trip"}) {
    int sum = 0;
    for (const json& bin : j[part]["bins"]) sum += bin["count"].get<int>();
    EXPECT_EQ(sum, j[part]["count"].get<int>()) << part;
    EXPECT_GT(sum, 0) << part;
  }
  EXPECT_LE(j["lateness"]["count"].get<int>(), 1000);
}

TEST(Device, RecordWritesRows) {
  const TempFolder folder;
  const Outcome outcome = runEmulated("record", {folder / "r.csv", "--for", "0.3"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(test::listFolder(folder.path()), Words{"r.csv"});
  const test::Columns columns = test::readColumns(folder / "r.csv");
  EXPECT_EQ(columns.size(), 12U);
  const std::vector<double>& t = columns.at("t");
  ASSERT_GT(t.size(), 10U);
  for (std::size_t i = 1; i < t.size(); ++i) EXPECT_GT(t[i], t[i - 1]);
  EXPECT_LT(std::abs(columns.at("x").back()), 0.06);
}

TEST(Device, RecordEndsWholeAtASignal) {
  const TempFolder folder;
  test::Background recording(test::tandemProgram(),
                             {"device", "record", folder / "r.csv", "--device", "simulated"});
  while (recording.readLine().find("s recorded") == std::string::npos) {
  }
  const Outcome outcome = recording.finish(SIGTERM);
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_EQ(test::listFolder(folder.path()), Words{"r.csv"});
}

TEST(Device, RecordThatFailsLeavesNothing) {
  const TempFolder folder;
  const Outcome outcome =
      runTandem({"device", "record", folder / "r.csv", "--device", "falcon@/dev/tandem-none"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(test::listFolder(folder.path()), Words{});
  expectRefused(runTandem({"device", "record", folder / "no/r.csv", "--device", "simulated"}), 2,
                {"no/r.csv", "folder"});
}

TEST(Device, FeelsTheCube) {
  const Outcome outcome = runEmulated("", {"--for", "4", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json j = json::parse(outcome.out);
  EXPECT_GT(j["force"]["max"].get<double>(), 0.5);
  EXPECT_GT(j["felt"]["max"].get<double>(), 0.5);
  EXPECT_LT(j["felt"]["max"].get<double>(), 8.5);
  EXPECT_GE(j["contacts"].get<int>(), 1);

  const Outcome lines = runEmulated("", {"--for", "1.5"});
  EXPECT_EQ(lines.status, 0) << lines.err;
  for (const char* word :
       {"3. Hold it in the middle", " N  hand ", "  cube ", "largest push of the motors"})
    EXPECT_NE(lines.out.find(word), std::string::npos) << lines.out;
}

TEST(Device, FeelsOtherScenarios) {
  const Outcome outcome = runTandem({"device", "--device", "simulated", "--for", "0.2", "--quiet",
                                     "--scenario", test::scenarioPath("playground.toml")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

TEST(Device, TakesPartAsAPeer) {
  const TempFolder folder;
  const std::string key = folder / "k";
  ASSERT_EQ(runTandem({"key", "new", key}).status, 0);
  const std::string first_address = test::ownLoopback() + ":17391";
  const std::string second_address = test::ownLoopback() + ":17392";
  const auto peer = [&](const char* site, const std::string& own, const std::string& other,
                        const char* device) {
    return runTandem({"peer", "--scenario", test::scenarioPath("playground.toml"), "--site", site,
                      "--bind", own, "--peer", other, "--key", key, "--device", device, "--out",
                      folder / "out", "--set", "experiment.duration=2"});
  };
  auto second =
      std::async(std::launch::async, peer, "2", second_address, first_address, "simulated");
  const Outcome first = peer("1", first_address, second_address, "emulated");
  ASSERT_EQ(first.status, 0) << first.err;
  const Outcome other = second.get();
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_NE(first.out.find("1. Pull the grip"), std::string::npos) << first.out;
  // From any place of the hand, the run begins at the scenario's start of its user, and then moves.
  const test::Columns columns = test::readColumns(folder / "out/site1.csv");
  // A loaded machine may start late: the grip has moved on a little by the first tick.
  EXPECT_NEAR(columns.at("device_x").front(), 0.0, 1e-3);
  const json one = json::parse(test::readFile(folder / "out/site1.json"));
  EXPECT_GT(one["network"]["states"]["given"].get<int>(), 0);
}

TEST(Device, APeersDeviceMustBeThere) {
  const TempFolder folder;
  const std::string key = folder / "k";
  ASSERT_EQ(runTandem({"key", "new", key}).status, 0);
  const Words words = {"peer",        "--scenario", test::scenarioPath("experiment1.toml"),
                       "--site",      "1",          "--bind",
                       "127.0.0.1:0", "--peer",     "127.0.0.1:9",
                       "--key",       key,          "--quiet",
                       "--device"};
  const auto with = [&](const std::string& device) {
    Words all = words;
    all.push_back(device);
    return runTandem(all);
  };
  for (const auto& [device, status] : {std::pair("falcon@/dev/tandem-none", 1), {"nonsense", 2}}) {
    const Outcome outcome = with(device);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(status == 1 ? "/dev/tandem-none" : "nonsense"), std::string::npos)
        << outcome.err;
  }
}

}  // namespace
}  // namespace tandem
