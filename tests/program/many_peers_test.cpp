// More than two `tandem peer` as processes on loopback.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem {
namespace {

using test::expectLine;
using test::Outcome;
using test::runAtOnce;
using test::runTandem;
using test::TempFolder;
using Words = std::vector<std::string>;

constexpr int kCount = 3;

/// Three users by average position, at the ports of a test.
struct Rig {
  explicit Rig(int first_port) : port(first_port) {
    EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0);
  }
  [[nodiscard]] std::string addressOf(int site) const {
    return test::ownLoopback() + ":" + std::to_string(port + site);
  }
  /// A site that knows the addresses of those whom it calls.
  [[nodiscard]] Words site(int number, const Words& more = {}) const {
    Words line = {"peer",
                  "--scenario",
                  test::scenarioPath("experiment1_many.toml"),
                  "--set",
                  "site=[{hand_force=[5,0,0]},{},{}]",
                  "--set",
                  "coordination.mode=average",
                  "--set",
                  "experiment.duration=0.5",
                  "--site",
                  std::to_string(number),
                  "--bind",
                  addressOf(number),
                  "--key",
                  folder / "k"};
    for (int other = 1; other <= kCount; ++other)
      if (other > number || (number == kCount && other == 1))
        line.insert(line.end(), {"--peer", std::to_string(other) + "=" + addressOf(other)});
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }

  TempFolder folder;
  int port;
};

TEST(ManyPeers, ThreeProcessesCooperate) {
  const Rig rig(17510);
  const std::string out = rig.folder / "out";
  const auto outcomes = runAtOnce(
      {rig.site(1, {"--out", out}), rig.site(2, {"--out", out}), rig.site(3, {"--out", out})});
  for (const Outcome& outcome : outcomes) {
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("2 of 2 live"), std::string::npos) << outcome.out;
  }
  EXPECT_EQ(test::listFolder(out),
            (Words{"scene1.csv", "scene2.csv", "scene3.csv", "site1.csv", "site1.json", "site2.csv",
                   "site2.json", "site3.csv", "site3.json"}));
  for (const std::string own : {"site1", "site2", "site3"}) {
    const auto summary = nlohmann::json::parse(test::readFile(out + "/" + own + ".json"));
    EXPECT_TRUE(std::isfinite(summary[own]["force"]["max"].get<double>()));
    EXPECT_LT(summary[own]["coherency"]["received_mean"].get<double>(), 0.1);
    EXPECT_FALSE(summary["network"].contains(own));
    for (const std::string other : {"site1", "site2", "site3"})
      EXPECT_TRUE(other == own || summary["network"][other]["states"]["given"] > 0) << own << other;
  }
  const auto first = nlohmann::json::parse(test::readFile(out + "/site1.json"));
  EXPECT_GT(first["site1"]["force"]["mean"].get<double>(), 1.0);
}

/// The last N of a site's report lines, and the largest.
std::pair<std::string, char> findMembers(const std::string& out) {
  const std::string mark = "| N = ";
  std::string last;
  char most = '0';
  for (std::size_t at = out.find(mark); at != std::string::npos; at = out.find(mark, at + 1)) {
    last = out.substr(at, mark.size() + 1);
    most = std::max(most, last.back());
  }
  return {last, most};
}

// Nobody waits for anybody. The first one is there before all others and after them.
TEST(ManyPeers, UsersComeAndGo) {
  const Rig rig(17550);
  const auto stay = [&](int number, double begin, const char* duration) {
    return std::async(std::launch::async, [&rig, number, begin, duration] {
      std::this_thread::sleep_for(std::chrono::duration<double>(begin));
      return runTandem(rig.site(
          number, {"--set", "coordination.follows_users=true", "--set", "site1.hand_force=[0,0,0]",
                   "--set", std::string("experiment.duration=") + duration}));
    });
  };
  auto first = stay(1, 0.0, "9"), second = stay(2, 1.5, "5"), third = stay(3, 2.5, "2.5");
  const Outcome outcome = first.get();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(second.get().status, 0);
  EXPECT_EQ(third.get().status, 0);
  const auto [last, most] = findMembers(outcome.out);
  EXPECT_EQ(most, '3') << outcome.out;
  EXPECT_EQ(last, "| N = 1") << outcome.out;
}

// The difference names the number of users before any key of a user.
TEST(ManyPeers, ASiteWithAnotherNumberOfUsersIsNamed) {
  const Rig rig(17520);
  const Words four = {"--set", "site=[{hand_force=[5,0,0]},{},{},{}]", "--peer",
                      "4=" + rig.addressOf(4)};
  const auto outcomes =
      runAtOnce({rig.site(1, four), rig.site(2, {"--wait", "8"}), rig.site(3, {"--wait", "8"})});
  expectLine(outcomes[0], 2, "site.count is 4 here and 3 there");
  for (std::size_t other : {1, 2}) EXPECT_NE(outcomes[other].status, 0);
}

TEST(ManyPeers, OneThatIsMissingIsNamed) {
  const Rig rig(17530);
  const auto outcomes = runAtOnce({rig.site(1, {"--wait", "3"}), rig.site(2, {"--wait", "3"})});
  EXPECT_TRUE(outcomes[0].status == 1 && outcomes[1].status == 1);
  expectLine(outcomes[0], 1, "site ");
}

TEST(ManyPeers, BadInputIsALine) {
  const Rig rig(17540);
  const auto with = [&](const Words& more) { return runTandem(rig.site(1, more)); };
  expectLine(runTandem(rig.site(4, {"--peer", "1=host:7001"})), 2, "--site 4: must be 1 to 3");
  expectLine(with({"--peer", "host:7004"}), 2, "say which of 3 sites it is");
  expectLine(with({"--peer", "4=host:7004"}), 2, "must name another site, 1 to 3 but not 1");
  expectLine(with({"--peer", "1=host:7004"}), 2, "must name another site, 1 to 3 but not 1");
  expectLine(with({"--peer", "2=host:7004"}), 2, "is the second for that site");
  expectLine(with({"--key", "file"}), 2, "is the second for that site");
  expectLine(with({"--key", "2=" + (rig.folder / "none")}), 2, "none");
  Words line = rig.site(2);
  line.resize(line.size() - 2);
  expectLine(runTandem(line), 2, "--peer is required");
  line.insert(line.end(), {"--peer", "1=" + rig.addressOf(1)});
  expectLine(runTandem(line), 2, "site 2 calls site 3, and needs its address: --peer 3=HOST:PORT");
  *std::find(line.begin(), line.end(), rig.folder / "k") = "1=" + (rig.folder / "k");
  line.insert(line.end(), {"--peer", "3=" + rig.addressOf(3)});
  expectLine(runTandem(line), 2, "--key: none for site 3: give --key 3=FILE");
}

}  // namespace
}  // namespace tandem
