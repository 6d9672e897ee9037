// Use of `tandem run`: options, outputs, exit status.

#include <cstdio>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

const std::string kExperiment1 = scenarioPath("experiment1.toml");
const std::string kExperiment2 = scenarioPath("experiment2.toml");

Json runJson(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "run");
  arguments.push_back("--json");
  const Outcome outcome = runTandem(arguments);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return Json::parse(outcome.out);
}

TEST(Run, JsonIsExactlyTheSummaryFile) {
  const TempFolder folder;
  const Outcome outcome = runTandem({"run", kExperiment1, "--json", "--out", folder / "a/b"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, readFile(folder / "a/b/summary.json"));
}

TEST(Run, SaysWhatCameOutToAReader) {
  const Outcome outcome = runTandem({"run", kExperiment1});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");  // progress is for terminals
  for (const char* word : {"coherency error, mean", "6.2", "state hash"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " in:\n" << outcome.out;
}

TEST(Run, QuietIsSilent) {
  const TempFolder folder;
  const Outcome outcome = runTandem({"run", kExperiment1, "--quiet", "--out", folder / "out"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(listFolder(folder / "out").size(), 4u);
}

TEST(Run, HelpSaysHow) {
  const Outcome outcome = runTandem({"run", "--help"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* option : {"--set", "--out", "--json", "--quiet"})
    EXPECT_NE(outcome.out.find(option), std::string::npos) << option;
}

TEST(Run, EqualInputsGiveEqualBytes) {
  for (const std::string& scenario : {kExperiment1, kExperiment2}) {
    const TempFolder folder;
    const std::vector<std::string> impaired = {
        "--set", "network.loss=0.1", "--set", "network.jitter=0.01", "--set", "network.seed=7"};
    for (const char* name : {"a", "b"}) {
      std::vector<std::string> arguments = {"run", scenario, "--quiet", "--out", folder / name};
      arguments.insert(arguments.end(), impaired.begin(), impaired.end());
      ASSERT_EQ(runTandem(arguments).status, 0);
    }
    for (const char* name : {"site1.csv", "site2.csv", "scene.csv"}) {
      const std::string a = readFile(folder.path() / "a" / name);
      EXPECT_GT(a.size(), 1000u);
      EXPECT_TRUE(a == readFile(folder.path() / "b" / name)) << name;
    }
    Json a = Json::parse(readFile(folder / "a/summary.json"));
    Json b = Json::parse(readFile(folder / "b/summary.json"));
    for (Json* summary : {&a, &b}) EXPECT_EQ(summary->erase("real_time_factor"), 1u);
    EXPECT_EQ(a.dump(), b.dump());
  }
}

TEST(Run, SetOverridesAnyKeyAndMayBeRepeated) {
  const Json changed =
      runJson({kExperiment1, "--set", "experiment.duration=0.2", "--set",
               "coordination.stiffness=317.5", "--set", "experiment.scheme=kinematic_proxy",
               "--set", "site2.hand_force=[-1, 0, 0]", "--set", "network.seed=12"});
  const Json& scenario = changed["scenario"];
  EXPECT_EQ(scenario["experiment"]["duration"], 0.2);
  EXPECT_EQ(scenario["coordination"]["stiffness"], 317.5);
  EXPECT_EQ(scenario["coordination"]["damping"], 30.0);  // from the file
  EXPECT_EQ(scenario["experiment"]["scheme"], "kinematic_proxy");
  EXPECT_EQ(scenario["site2"]["hand_force"], Json({-1.0, 0.0, 0.0}));
  EXPECT_EQ(scenario["network"]["seed"], 12);
}

TEST(Run, OfTwoOverridesOfOneKeyTheLastCounts) {
  const Json run = runJson({kExperiment1, "--set", "experiment.duration=0.4", "--set",
                            "object.mass=0.7", "--set", "experiment.duration=0.2"});
  EXPECT_EQ(run["scenario"]["experiment"]["duration"], 0.2);
  EXPECT_EQ(run["scenario"]["object"]["mass"], 0.7);
}

TEST(Run, AnOverrideIsTheSameAsTheKeyInTheFile) {
  const TempFolder folder;
  std::string text = readFile(kExperiment1);
  const std::string line = "stiffness = 4000.0";
  text.replace(text.find(line), line.size(), "stiffness = 3210.5");
  const std::string path = folder.write("own.toml", text);
  EXPECT_EQ(runJson({path})["state_hash"],
            runJson({kExperiment1, "--set", "contact.stiffness=3210.5"})["state_hash"]);
}

// Each of these keys must change the motion: a key that is read but not used would not.
TEST(Run, EveryKeyOfTheModelChangesTheMotion) {
  const Json before = runJson({kExperiment1});
  for (const char* text :
       {"experiment.scheme=virtual_coupling", "contact.stiffness=3900", "contact.damping=2",
        "coordination.stiffness=210", "coordination.damping=29", "object.mass=0.21",
        "object.damping=0.1", "proxy.mass=0.11", "proxy.damping=0.1", "device.mass=0.11",
        "device.damping=0.6", "site1.hand_force=[5.1,0,0]", "site2.hand_force=[-0.1,0,0]",
        "network.delay=0.051", "network.rate=120", "network.jitter=0.01", "network.loss=0.2",
        "network.reorder=0.2", "rates.haptic=960"}) {
    EXPECT_NE(runJson({kExperiment1, "--set", text})["state_hash"], before["state_hash"]) << text;
  }
}

#ifdef TANDEM_WITH_FLOAT
TEST(Run, FloatProgramSaysSoAndAgrees) {
  const Json wide = runJson({kExperiment1});
  const Outcome outcome = runProgram(test::tandemFloatProgram(), {"run", kExperiment1, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json narrow = Json::parse(outcome.out);
  EXPECT_EQ(wide["scalar"], "float64");
  EXPECT_EQ(narrow["scalar"], "float");
  // The island is double with any Bullet scalar; 1e-5 m is far above float's rounding.
  EXPECT_NEAR(narrow["coherency"]["mean_abs"].get<double>(),
              wide["coherency"]["mean_abs"].get<double>(), 1e-5);
}
#endif

// The scene turns with its axis, and values in the scene's own frame stay. In these smooth runs,
// rounding of the rotation grows by contact gains only, not by chaos.
TEST(Run, AxisTurnsTheSceneAndNothingElse) {
  for (const std::string& scenario : {kExperiment1, kExperiment2}) {
    const Json along_x = runJson({scenario});
    for (const char* axis : {"[0,0,1]", "[0.6,0,0.8]", "[-1,0,0]", "[0,-1,0]"}) {
      const Json turned = runJson({scenario, "--set", std::string("experiment.axis=") + axis});
      for (const char* number :
           {"/coherency/mean_abs", "/coherency/max_abs", "/site1/coherency/received_mean",
            "/site2/coherency/received_mean", "/site1/force/max", "/site1/force/mean",
            "/site2/force/max", "/site2/force/mean", "/site1/device_end", "/site2/device_end"}) {
        const Json::json_pointer place(number);
        EXPECT_NEAR(turned[place].get<double>(), along_x[place].get<double>(), 1e-9)
            << number << " along " << axis;
      }
      for (const char* site : {"site1", "site2"})
        EXPECT_EQ(turned[site]["contact_transitions"], along_x[site]["contact_transitions"]);
    }
  }
}

TEST(Run, OutReplacesAnOlderRun) {
  const TempFolder folder;
  const std::string out = folder / "out";
  ASSERT_EQ(runTandem({"run", kExperiment1, "--quiet", "--out", out}).status, 0);
  const Outcome again =
      runTandem({"run", kExperiment1, "--json", "--out", out, "--set", "experiment.duration=0.1"});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(readColumns(out + "/site1.csv").at("t").size(), 100u);
  EXPECT_EQ(readFile(out + "/summary.json"), again.out);
}

TEST(Program, SaysItsVersion) {
  const Outcome outcome = runTandem({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  unsigned major = 0, minor = 0, patch = 0;
  char end = 0;
  EXPECT_EQ(std::sscanf(outcome.out.c_str(), "tandem %u.%u.%u%c", &major, &minor, &patch, &end), 4);
  EXPECT_EQ(end, '\n');
}

}  // namespace
}  // namespace tandem::test
