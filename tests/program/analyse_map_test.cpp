// `tandem analyse --map` and `--figures`: files, refusals, and analyses in a report.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tandem/coordination/stability_advice.h"

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Words = std::vector<std::string>;

const std::string kGains = "network.delay,coordination.stiffness";

Outcome analyse(const std::string& file, const Words& more) {
  Words all = {"analyse", scenarioPath(file)};
  all.insert(all.end(), more.begin(), more.end());
  return runTandem(all);
}

/// Draws a small map into a folder.
Outcome drawMap(const std::string& out, const Words& more = {}) {
  Words all = {"--map", kGains, "--points", "4x3", "--out", out};
  all.insert(all.end(), more.begin(), more.end());
  return analyse("experiment1.toml", all);
}

TEST(AnalyseMap, WritesNumbersAndAFigure) {
  const TempFolder folder;
  const Outcome outcome = drawMap(folder / "a/b");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, folder / "a/b/stability.json\n");
  EXPECT_EQ(outcome.err, "");  // progress is for terminals
  EXPECT_EQ(listFolder(folder / "a/b"),
            (Words{"map-remote_dynamic_proxy.csv", "map.png", "map.svg", "stability.json"}));
  const Columns map = readColumns(folder / "a/b/map-remote_dynamic_proxy.csv");
  ASSERT_EQ(map.at("rate").size(), 12u);
  LoopSettings there;
  for (std::size_t i = 0; i < 12; ++i) {
    there.delay = map.at("network.delay")[i];
    there.coordination.stiffness = map.at("coordination.stiffness")[i];
    EXPECT_NEAR(map.at("rate")[i], computeWorstRate(there), 1e-3) << i;
  }
}

TEST(AnalyseMap, IsPrintedWithoutAFolder) {
  const Outcome outcome = runTandem(
      {"analyse", test::scenarioPath("experiment1.toml"), "--map", kGains, "--points", "4x3"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1 + 4 * 3) << outcome.out;
}

TEST(AnalyseMap, JsonIsExactlyTheFile) {
  const TempFolder folder;
  const Outcome outcome = drawMap(folder / "a", {"--json", "--set", "device.damping=0.7"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, readFile(folder / "a/stability.json"));
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["format"], "tandem-stability");
  EXPECT_EQ(json["title"], "Experiment I: cooperative manipulation");
  EXPECT_EQ(json["gains"]["device.damping"], 0.7);
  EXPECT_EQ(json["maps"][0]["x"]["key"], "network.delay");
  EXPECT_EQ(json["maps"][0]["y"]["points"], 3);
  EXPECT_EQ(json["maps"][0]["y"]["value"], 200.0);
}

TEST(AnalyseMap, ScenarioWithoutATitleHasItsFilesName) {
  const TempFolder folder;
  const Outcome outcome = runTandem({"analyse", folder.write("own.toml", ""), "--map", kGains,
                                     "--points", "2", "--out", folder / "a", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["title"], "own");
}

TEST(AnalyseMap, ACheckFailsAsWithoutAMap) {
  const TempFolder folder;
  EXPECT_EQ(drawMap(folder / "a", {"--check"}).status, 3);
  EXPECT_EQ(drawMap(folder / "a", {"--check", "--set", "device.damping=3"}).status, 0);
}

TEST(AnalyseMap, ReplacesAnEarlierAnalysisOnly) {
  const TempFolder folder;
  ASSERT_EQ(drawMap(folder / "a").status, 0);
  folder.write("a/own.txt", "kept");
  ASSERT_EQ(drawMap(folder / "a", {"--set", "experiment.scheme=kinematic_proxy"}).status, 0);
  EXPECT_EQ(listFolder(folder / "a"),
            (Words{"map-kinematic_proxy.csv", "map.png", "map.svg", "own.txt", "stability.json"}));
}

TEST(AnalyseFigures, ShowAllSchemesAndBecomeAReport) {
  const TempFolder folder;
  const Outcome one =
      analyse("experiment1.toml", {"--figures", "--points", "2", "--out", folder / "one"});
  ASSERT_EQ(one.status, 0) << one.err;
  Words expected = {"map-kinematic_proxy.csv", "map-remote_dynamic_proxy.csv",
                    "map-virtual_coupling.csv", "stability.json"};
  for (const char* figure : {"damping", "fine", "limits", "map", "users"})
    for (const char* suffix : {".png", ".svg"}) expected.push_back(std::string(figure) + suffix);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(listFolder(folder / "one"), expected);

  const Outcome other =
      analyse("experiment2.toml", {"--figures", "--points", "2", "--out", folder / "other"});
  ASSERT_EQ(other.status, 0) << other.err;
  const Words files = listFolder(folder / "other");
  EXPECT_EQ(std::count(files.begin(), files.end(), "touch.svg"), 1);
  const Outcome plot = runTandem({"plot", folder / "one", folder / "other"});
  ASSERT_EQ(plot.status, 0) << plot.err;
  EXPECT_EQ(plot.out, folder / "one/report.html\n");
  const std::string report = readFile(folder / "one/report.html");
  for (const char* words : {"Stability with lasting contact", "stability-map-2",
                            "stability-damping", "stability-limits-1", "stability-touch-1"})
    EXPECT_NE(report.find(words), std::string::npos) << words;
}

TEST(AnalyseMap, RefusesByALine) {
  const TempFolder folder;
  const std::string out = folder / "out";
  const auto refuse = [&](const Words& more, const std::string& words) {
    const Outcome outcome = analyse("experiment1.toml", more);
    expectLine(outcome, 2, words);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(listFolder(out), Words{});
  };
  const auto map = [&](const std::string& gains) { return Words{"--map", gains, "--out", out}; };
  refuse(map("network.delay"), "--map network.delay: give two gains");
  refuse(map("network.delay,object.mass"), "\"object.mass\" is no gain; give two of coordination.");
  refuse(map("network.delay,network.delay"), "must be two different gains");
  for (const char* points : {"1", "401", "60x", "60x1", "many", "-5"})
    refuse({"--map", kGains, "--out", out, "--points", points}, "must be 2 to 400");
  refuse({"--figures"}, "--out FOLDER");
  refuse({"--figures", "--map", kGains, "--out", out}, "give one of them");
  refuse({"--figures", "--worst-phase", "--out", out}, "--worst-phase");
  refuse({"--points", "5"}, "--map X,Y");
  refuse({"--out", out}, "--map X,Y");
  refuse({"--map", kGains, "--out", out, "--set", "network.delay=0.6"}, "delay = 0.6");
  refuse({"--map", kGains, "--out", out, "--users", "1"}, "--users 1");
}

TEST(AnalyseMap, RefusesAFolderThatIsNone) {
  const TempFolder folder;
  const std::string file = folder.write("file", "not a folder");
  for (const std::string& out : {file, file + "/below", std::string("/proc/none"), std::string()})
    expectLine(drawMap(out), 2, "--out " + out + ": cannot make files here");
  EXPECT_EQ(readFile(file), "not a folder");
}

TEST(AnalyseMap, RefusesAFolderWithOtherThings) {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "run");
  folder.write("run/summary.json", "{}");
  expectLine(drawMap(folder / "run"), 2, "run: holds other things; choose a new folder");
  EXPECT_EQ(listFolder(folder / "run"), Words{"summary.json"});
}

}  // namespace
}  // namespace tandem::test
