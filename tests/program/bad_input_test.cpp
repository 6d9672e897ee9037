// Bad use and bad scenarios give one line with place, problem and allowed values; status 2; nothing
// is written. Later failures give one line and status 1; no file is half-written.

#include <algorithm>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Words = std::vector<std::string>;

const std::string kExperiment1 = scenarioPath("experiment1.toml");

void expectOneLine(const Outcome& outcome, int status, const Words& words) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.ends_with('\n')) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << '"' << word << "\" in: " << outcome.err;
}

/// Runs Experiment I with one override. It must be refused by a line with these words.
void expectOverrideRefused(const std::string& text, const Words& words) {
  SCOPED_TRACE("--set " + text);
  const TempFolder folder;
  expectOneLine(runTandem({"run", kExperiment1, "--set", text, "--out", folder / "out", "--json"}),
                2, words);
  EXPECT_EQ(listFolder(folder / "out"), Words{});
}

/// The same with a scenario file of this text. Its path is one of the words.
void expectFileRefused(const std::string& text, const Words& words) {
  SCOPED_TRACE(text);
  const TempFolder folder;
  const std::string file = folder.write("own.toml", text);
  const Outcome outcome = runTandem({"run", file, "--out", folder / "out"});
  expectOneLine(outcome, 2, words);
  expectOneLine(outcome, 2, {file});
  EXPECT_EQ(listFolder(folder / "out"), Words{});
}

TEST(BadInput, UnknownKey) {
  expectFileRefused("[network]\nlatency = 0.1\n",
                    {"network.latency", "0.1", "no such key", "network.delay", "network.rate"});
  expectFileRefused("[netwrok]\ndelay = 0.1\n", {"netwrok.delay", "no such key", "network.*"});
  expectFileRefused("delay = 0.1\n", {"delay", "no such key"});
  expectFileRefused("[netwrok]\n", {"netwrok", "no such key"});
  expectFileRefused("[contact.stiffness]\n", {"contact.stiffness", "finite number"});
  expectFileRefused("[[network]]\ndelay = 0.1\n", {"network"});
  expectOverrideRefused("contact.stifness=1", {"contact.stifness", "1", "contact.stiffness"});
}

TEST(BadInput, ContactModel) {
  expectOverrideRefused("contact.model=soft", {"contact.model", "soft", "island", "native_rigid",
                                               "native_soft", "spring_6dof", "point_to_point"});
  const Words native = {"run", kExperiment1, "--set", "contact.model=native_soft", "--set"};
  for (const char* other : {"experiment.axis=[0.6,0.8,0]", "bridge.injection=impulse",
                            "experiment.scheme=kinematic_proxy"}) {
    SCOPED_TRACE(other);
    Words arguments = native;
    arguments.insert(arguments.end(), {other, "--set", "rates.host=1000"});
    if (std::string(other).ends_with("kinematic_proxy"))
      arguments.insert(arguments.end(), {"--set", "experiment.kind=user_contact"});
    const std::string key = std::string(other).substr(0, std::string(other).find('='));
    expectOneLine(runTandem(arguments), 2, {"contact.model", "native_soft", key});
  }
}

TEST(BadInput, WrongType) {
  expectFileRefused("[contact]\nstiffness = \"4000\"\n",
                    {"contact.stiffness", "4000", "finite number, 0 or more"});
  expectFileRefused("[contact]\nstiffness = [4000]\n", {"contact.stiffness", "finite number"});
  expectFileRefused("[experiment]\nguide = 1\n", {"experiment.guide", "1", "true or false"});
  expectFileRefused("[experiment]\nscheme = 3\n", {"experiment.scheme", "3", "kinematic_proxy"});
  expectFileRefused("[experiment]\naxis = 1\n", {"experiment.axis", "1", "three numbers"});
  expectFileRefused("[experiment]\naxis = [1, 0]\n", {"experiment.axis", "three numbers"});
  expectFileRefused("[site1]\nhand_force = [1, \"a\", 0]\n", {"site1.hand_force", "numbers"});
  expectFileRefused("[network]\nseed = 0.5\n", {"network.seed", "0.5", "whole number"});
  expectFileRefused("title = 5\n", {"title", "5", "text in quotes"});
  expectOverrideRefused("object.mass=true", {"object.mass", "true", "finite number above 0"});
  expectOverrideRefused("object.mass=heavy", {"object.mass", "heavy", "finite number above 0"});
}

TEST(BadInput, NumberOutOfRange) {
  expectOverrideRefused("object.mass=-0.2", {"object.mass", "-0.2", "above 0"});
  expectOverrideRefused("object.mass=0", {"object.mass", "0", "above 0"});
  expectOverrideRefused("proxy.mass=-1", {"proxy.mass", "-1", "above 0"});
  expectOverrideRefused("device.mass=-1", {"device.mass", "-1", "above 0"});
  expectOverrideRefused("contact.damping=-1", {"contact.damping", "-1", "0 or more"});
  expectOverrideRefused("network.rate=0", {"network.rate", "0", "above 0"});
  expectOverrideRefused("rates.haptic=0", {"rates.haptic", "0", "10 to 100000"});
  expectOverrideRefused("rates.host=0", {"rates.host", "0", "1 to 100000"});
  expectOverrideRefused("network.loss=1.5", {"network.loss", "1.5", "probability"});
  expectOverrideRefused("experiment.duration=0", {"experiment.duration", "0", "above 0"});
  expectOverrideRefused("experiment.axis=[1,1,0]", {"experiment.axis", "1, 1, 0", "unit vector"});
  expectOverrideRefused("experiment.axis=[0,0,0]", {"experiment.axis", "0, 0, 0", "unit vector"});
}

TEST(BadInput, NotFinite) {
  for (const char* key : {"contact.stiffness", "coordination.damping", "object.mass",
                          "network.delay", "rates.host", "experiment.duration"}) {
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e400"})
      expectOverrideRefused(std::string(key) + "=" + value, {key});
  }
  expectOverrideRefused("site1.hand_force=[nan,0,0]", {"site1.hand_force", "nan", "finite"});
  expectOverrideRefused("experiment.axis=[nan,0,0]", {"experiment.axis", "nan"});
}

TEST(BadInput, ChoiceThatIsNone) {
  expectOverrideRefused("experiment.scheme=quantum",
                        {"experiment.scheme", "quantum", "virtual_coupling", "kinematic_proxy",
                         "remote_dynamic_proxy"});
  expectOverrideRefused("experiment.kind=chess", {"experiment.kind", "chess", "user_contact"});
  expectOverrideRefused("bridge.injection=magic",
                        {"bridge.injection", "magic", "handoff", "impulse"});
}

TEST(BadInput, KeysThatDoNotGoTogether) {
  expectOverrideRefused("network.delay=1.5", {"network.delay", "1.5", "experiment.duration"});
  expectOverrideRefused("network.rate=2000", {"network.rate", "2000", "rates.haptic"});
  expectOverrideRefused("bridge.injection=impulse",
                        {"rates.host", "240", "rates.haptic", "impulse", "handoff"});
  expectOverrideRefused("experiment.duration=1e-5", {"experiment.duration", "1e-05"});
  expectOverrideRefused("site1.hand=minimum_jerk", {"site1.hand_waypoints"});
  expectOverrideRefused("site1.grips=[[0.1, 0.2]]", {"site1.grips", "experiment.guide"});
  expectOverrideRefused("site1.grips=[[0.2, 0.1]]", {"site1.grips", "growing"});
  expectOverrideRefused("site2.hand=csv", {"site2.hand_file"});
}

TEST(BadInput, MalformedOverride) {
  for (const char* text : {"contact.stiffness", "=5", ""})
    expectOverrideRefused(text, {"--set", "key=value"});
  expectOverrideRefused("contact.stiffness=", {"contact.stiffness", "finite number"});
  // One override sets one key, and its message stays one line.
  expectOverrideRefused("contact.stiffness=1\nobject.mass=5",
                        {"contact.stiffness", "finite number"});
  expectOverrideRefused("contact.\nstiffness=1", {"no such key"});
}

TEST(BadInput, NotToml) {
  expectFileRefused("this is no scenario\n", {":1:", "not TOML"});
  expectFileRefused("[network]\ndelay = \n", {":2:", "not TOML"});
  expectFileRefused(std::string("\0\x01\xff\xfe", 4), {"not TOML"});
  expectFileRefused("[network]\ndelay = 0.1\ndelay = 0.2\n", {":3:", "not TOML"});
}

TEST(BadInput, FileThatCannotBeRead) {
  const TempFolder folder;
  for (const std::string& path : {folder / "missing.toml", folder.path().string()}) {
    expectOneLine(runTandem({"run", path, "--out", folder / "out"}), 2, {path, "cannot read"});
    EXPECT_EQ(listFolder(folder / "out"), Words{});
  }
}

TEST(BadInput, ScenarioThatIsADeviceAPipeOrTooLarge) {
  const TempFolder folder;
  const std::string pipe = folder / "pipe",
                    large = folder.write("large", std::string(1 << 20, '#'));
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(runTandem({"run", large, "--quiet"}).status, 0);  // 1 MiB of comment
  folder.write("large", std::string((1 << 20) + 1, '#'));
  for (const std::string& path : {pipe, std::string("/dev/zero"), std::string("/dev/null")})
    expectOneLine(runTandem({"run", path, "--out", folder / "out"}), 2, {path, "device or a pipe"});
  expectOneLine(runTandem({"run", large, "--out", folder / "out"}), 2, {large, "1 MiB"});
  expectOneLine(runTandem({"link", "--listen", ":0", "--forward", "127.0.0.1:9", "--script", pipe}),
                2, {pipe, "device or a pipe"});
  EXPECT_EQ(listFolder(folder / "out"), Words{});
}

TEST(BadInput, TomlThatNestsTooDeep) {
  std::string key = "a";
  for (int i = 0; i < 40'000; ++i) key += ".a";
  expectFileRefused("# 1\n" + key + " = 1\n", {":2:", "64 deep"});
  expectFileRefused("[" + key + "]\n", {":1:", "64 deep"});
  expectFileRefused("title = " + std::string(65, '[') + std::string(65, ']'), {":1:", "64 deep"});
  expectOverrideRefused("title={" + key.substr(0, 99'999) + "=1}", {"--set title", "64 deep"});
  const TempFolder folder;
  const std::string script = folder.write("script", key + " = 1\n");
  expectOneLine(
      runTandem({"link", "--listen", ":0", "--forward", "127.0.0.1:9", "--script", script}), 2,
      {script + ":1:", "64 deep"});
}

TEST(BadInput, HandFileThatCannotBeRead) {
  expectOverrideRefused("site1.hand_file=1", {"site1.hand_file", "text in quotes"});
  const TempFolder folder;
  const auto run = [&] {
    return runTandem({"run", kExperiment1, "--set", "site1.hand=csv", "--set",
                      "site1.hand_file=" + (folder / "hand.csv"), "--out", folder / "out"});
  };
  expectOneLine(run(), 2, {"experiment1.toml", "site1.hand_file", folder / "hand.csv", "readable"});
  folder.write("hand.csv", "t,force_x,force_y,force_z\n0,1,2,many\n");
  expectOneLine(run(), 2, {"site1.hand_file", "hand.csv:2", "many"});
  folder.write("hand.csv", "t,force_x,force_y,force_z\n0,1e300,0,0\n");
  expectOneLine(run(), 2, {"site1.hand_file", "hand.csv:2", "1e300", "1e6 N"});
  EXPECT_EQ(listFolder(folder / "out"), Words{});
}

TEST(BadInput, FolderThatCannotBeWritten) {
  const TempFolder folder;
  const std::string file = folder.write("file", "not a folder");
  for (const std::string& out : {file, file + "/below", std::string("/proc/none"), std::string()}) {
    expectOneLine(runTandem({"run", kExperiment1, "--out", out, "--json"}), 2,
                  {"--out " + out, "writable"});
  }
  EXPECT_EQ(readFile(file), "not a folder");
  if (geteuid() == 0) return;  // root may write anywhere
  std::filesystem::permissions(
      folder.path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  expectOneLine(runTandem({"run", kExperiment1, "--out", folder / "out"}), 2, {"writable"});
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
}

TEST(BadInput, CommandLine) {
  expectOneLine(runTandem({}), 2, {"command is missing", "run", "--help"});
  expectOneLine(runTandem({"fly"}), 2, {"fly", "run, plot", "--help"});
  expectOneLine(runTandem({"run"}), 2, {"scenario", "--help"});
  expectOneLine(runTandem({"run", kExperiment1, "--fast"}), 2, {"--fast", "--help"});
  expectOneLine(runTandem({"run", kExperiment1, "second.toml"}), 2, {"second.toml", "--help"});
  expectOneLine(runTandem({"run", kExperiment1, "--set"}), 2, {"--set", "--help"});
  expectOneLine(runTandem({"plot"}), 2, {"folders", "--help"});
}

#ifdef TANDEM_WITH_FLOAT
TEST(BadInput, FloatProgramRefusesTheSame) {
  expectOneLine(
      runProgram(test::tandemFloatProgram(), {"run", kExperiment1, "--set", "object.mass=-1"}), 2,
      {"object.mass", "-1"});
}
#endif

// The device's speed exceeds a double's range: the run fails after its start.
TEST(FailedRun, LeavesNothingBehind) {
  const TempFolder folder;
  expectOneLine(runTandem({"run", kExperiment1, "--set", "site1.hand_force=[1e6,0,0]", "--set",
                           "device.mass=1e-306", "--set", "device.damping=0", "--out",
                           folder / "out", "--json"}),
                1, {"site 1"});
  EXPECT_EQ(listFolder(folder / "out"), Words{});
}

TEST(FailedRun, FullDiskLeavesNothingHalfWritten) {
  const TempFolder folder;
  Start start;
  start.largest_file = 20000;  // [bytes]; the tables are larger
  const std::vector<std::string> arguments = {"run", kExperiment1, "--out", folder / "out",
                                              "--quiet"};
  expectOneLine(runTandem(arguments, start), 1, {"site1.csv", "full"});
  EXPECT_EQ(listFolder(folder / "out"), Words{});

  // An older run stays whole.
  ASSERT_EQ(runTandem(arguments).status, 0);
  const std::string before = readFile(folder / "out/summary.json");
  const Words names = listFolder(folder / "out");
  expectOneLine(runTandem(arguments, start), 1, {"site1.csv", "full"});
  EXPECT_EQ(readFile(folder / "out/summary.json"), before);
  EXPECT_EQ(listFolder(folder / "out"), names);
}

TEST(FailedRun, SaysThatItsOutputWasLost) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  Start start;
  start.stdout_path = "/dev/full";
  expectOneLine(runTandem({"run", kExperiment1, "--json"}, start), 1, {"output"});
}

}  // namespace
}  // namespace tandem::test
