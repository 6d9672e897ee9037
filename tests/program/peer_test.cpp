// `tandem peer` as processes on loopback. The precision of a live run depends on the machine. Only
// properties that hold on any machine are asserted.

#include <cmath>
#include <csignal>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tandem/plugin/udp_socket.h"

#include "program/background.h"
#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::Outcome;
using test::runTandem;
using test::scenarioPath;
using test::TempFolder;

/// Makes a key file in a folder.
std::string makeKey(const TempFolder& folder, const std::string& name) {
  EXPECT_EQ(runTandem({"key", "new", folder / name}).status, 0);
  return folder / name;
}

/// Arguments of one of two sites; each test has its own ports.
std::vector<std::string> peer(int site, int first_port, const std::string& key,
                              const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {
      "peer",
      "--scenario",
      scenarioPath("experiment1.toml"),
      "--site",
      std::to_string(site),
      "--bind",
      test::ownLoopback() + ":" + std::to_string(first_port + site - 1),
      "--peer",
      test::ownLoopback() + ":" + std::to_string(first_port + 2 - site),
      "--key",
      key};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expectOneLine(const Outcome& outcome, int status, const std::string& word) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
  // A note about memory that cannot be locked may precede it.
  const std::size_t line = outcome.err.find("tandem: note");
  const std::string rest = line == 0 ? outcome.err.substr(outcome.err.find('\n') + 1) : outcome.err;
  EXPECT_EQ(rest.find('\n'), rest.size() - 1) << outcome.err;
}

struct Both {
  Outcome first, second;
};
Both runBoth(const std::vector<std::string>& first, const std::vector<std::string>& second) {
  auto other = std::async(std::launch::async, [&] { return runTandem(second); });
  Both both;
  both.first = runTandem(first);
  both.second = other.get();
  return both;
}

TEST(Peer, TwoProcessesCooperate) {
  const TempFolder folder;
  const std::string key = makeKey(folder, "k");
  const std::vector<std::string> more = {"--set", "experiment.duration=0.5", "--out",
                                         folder / "out"};
  const Both both = runBoth(peer(1, 17310, key, more), peer(2, 17310, key, more));
  ASSERT_EQ(both.first.status, 0) << both.first.err;
  ASSERT_EQ(both.second.status, 0) << both.second.err;
  EXPECT_NE(both.first.out.find("live"), std::string::npos) << both.first.out;
  EXPECT_EQ(test::listFolder(folder / "out"),
            (std::vector<std::string>{"scene1.csv", "scene2.csv", "site1.csv", "site1.json",
                                      "site2.csv", "site2.json"}));
  for (const char* name : {"site1", "site2"}) {
    const auto summary = nlohmann::json::parse(test::readFile(folder / "out/" + name + ".json"));
    // The ticks in which the force fades come on top.
    EXPECT_GE(summary["loop"]["ticks"].get<int>() + summary["loop"]["skipped"].get<int>(), 500);
    const double force = summary[name]["force"]["max"];
    EXPECT_TRUE(std::isfinite(force));
    EXPECT_GT(summary["network"]["states"]["given"].get<int>(), 0);
    EXPECT_EQ(summary["network"]["datagrams"]["refused"].value("forged", 0), 0);
    // All bodies are in each picture, at most 30 a second.
    const std::size_t bodies = summary["scene"]["bodies"].size();
    EXPECT_EQ(bodies, 3u) << "hand, cube and proxy";
    const std::string scene = std::string("scene") + name[4] + ".csv";
    const std::size_t rows = test::readColumns(folder / ("out/" + scene)).at("t").size();
    EXPECT_EQ(rows % bodies, 0u);
    EXPECT_GE(rows, 2 * bodies);
    EXPECT_LE(rows, 17 * bodies);
  }
  // User 1 pushes the cube towards user 2.
  const auto first = nlohmann::json::parse(test::readFile(folder / "out/site1.json"));
  EXPECT_GT(first["site1"]["force"]["mean"].get<double>(), 1.0);
  EXPECT_LT(first["site1"]["force"]["max"].get<double>(), 20.0);
}

TEST(Peer, OtherScenariosAreNamed) {
  const TempFolder folder;
  const std::string key = makeKey(folder, "k");
  const Both both = runBoth(peer(1, 17320, key), peer(2, 17320, key, {"--set", "object.mass=0.3"}));
  for (const Outcome* outcome : {&both.first, &both.second}) {
    // One of them may get the other's farewell before it could compare.
    if (outcome->status == 2)
      expectOneLine(*outcome, 2, "object.mass");
    else
      EXPECT_EQ(outcome->status, 1) << outcome->err;
  }
  EXPECT_TRUE(both.first.status == 2 || both.second.status == 2);
}

TEST(Peer, AnotherKeyIsNamed) {
  const TempFolder folder;
  const std::vector<std::string> wait = {"--wait", "8"};
  const Both both = runBoth(peer(1, 17330, makeKey(folder, "a"), wait),
                            peer(2, 17330, makeKey(folder, "b"), wait));
  expectOneLine(both.first, 1, "another key");
  expectOneLine(both.second, 1, "it calls, but with another key");
}

TEST(Peer, NobodyAnswers) {
  const TempFolder folder;
  expectOneLine(runTandem(peer(1, 17340, makeKey(folder, "k"), {"--wait", "0.5", "--quiet"})), 1,
                "did not join within 0.5 s");
}

TEST(Peer, PortInUse) {
  const TempFolder folder;
  const auto arguments = peer(1, 17350, makeKey(folder, "k"));
  const net::UdpSocket taken(resolveAddress(test::ownLoopback() + ":17350"));
  expectOneLine(runTandem(arguments), 2, "choose another port");
}

TEST(Peer, EndsAtASignal) {
  const TempFolder folder;
  test::Background waiting(test::tandemProgram(), peer(1, 17360, makeKey(folder, "k")));
  while (waiting.readLine().find("waiting") == std::string::npos) {
  }
  const Outcome outcome = waiting.finish(SIGINT);
  EXPECT_EQ(outcome.status, 0) << outcome.out;
}

TEST(Peer, BadInput) {
  const TempFolder folder;
  const std::string key = makeKey(folder, "k");
  auto arguments = peer(1, 17370, key);
  const auto with = [&](const std::string& option, const std::string& value) {
    auto changed = arguments;
    for (std::size_t i = 0; i + 1 < changed.size(); ++i)
      if (changed[i] == option) changed[i + 1] = value;
    return runTandem(changed);
  };
  expectOneLine(with("--site", "3"), 2, "must be 1 or 2");
  expectOneLine(with("--key", folder / "none"), 2, "none");
  expectOneLine(with("--bind", "nonsense"), 2, "is no address");
  expectOneLine(with("--bind", "192.0.2.1:17370"), 2, "choose an address of this machine");
  expectOneLine(with("--peer", "127.0.0.1"), 2, "the port is missing");
  expectOneLine(with("--scenario", folder / "no.toml"), 2, "no.toml");
}

}  // namespace
}  // namespace tandem
