// Two servers in one process, each with the plugin: Experiment I of the README.

#include <chrono>
#include <cstdio>
#include <thread>

#include <unistd.h>

#include "tandem/tandem.h"

#include "plugin_rig.h"

namespace tandem::test {
namespace {

/// One user of the README's example.
struct User {
  PluginHost host;

  User(int self, double start) {
    const int cube = host.engine.add(makeStubCube());
    host.engine.time_step = 1.0 / 60.0;
    const std::string x = std::to_string(start);
    host.command("device kind=simulated start=" + x + ",0,0");
    host.command("site self=" + std::to_string(self) + " peers=2 guide=1,0,0");
    host.command("share body=" + std::to_string(cube));
  }
  void connect(int peer, const std::string& start) {
    host.command("connect peer=" + std::to_string(peer) + " link=0 start=" + start);
  }
};

void expectReadme(User& first, User& second) {
  EXPECT_NEAR(first.host.engine.bodies.at(0).state.p_W.x(), 0.1266, 5e-5);
  EXPECT_NEAR(second.host.engine.bodies.at(0).state.p_W.x(), 0.1199, 5e-5);
  EXPECT_NEAR(first.host.ask("force").doubles()[0], -5.041, 5e-4);
}

TEST(TwoUsers, MeetOverASimulatedLink) {
  User first(1, -0.03), second(2, 0.03);
  const std::string link = "link kind=simulated name=between delay=0.05";
  EXPECT_EQ(first.host.command(link), 0);
  EXPECT_NE(second.host.refusal("link kind=simulated name=between delay=0.04").find("same"),
            std::string::npos);
  EXPECT_EQ(second.host.command(link), 0);
  EXPECT_NE(second.host.refusal(link).find("both its ends"), std::string::npos);
  first.connect(2, "0.03,0,0");
  second.connect(1, "-0.03,0,0");
  first.host.command("hand force=5,0,0");
  for (int step = 0; step < 60; ++step) {
    first.host.step();
    second.host.step();
  }
  expectReadme(first, second);
  EXPECT_GT(first.host.read()[14], 50.0);  // packets taken
}

TEST(TwoUsers, CarryPacketsByHand) {
  User first(1, -0.03), second(2, 0.03);
  for (User* user : {&first, &second}) user->host.command("link kind=manual");
  first.connect(2, "0.03,0,0");
  second.connect(1, "-0.03,0,0");
  first.host.command("hand force=5,0,0");
  int carried = 0;
  for (int step = 0; step < 60; ++step) {
    for (User* user : {&first, &second}) user->host.step();
    for (User* from : {&first, &second}) {
      User& to = from == &first ? second : first;
      for (PluginAnswer packet = from->host.ask("pop link=0"); packet.status == 1;
           packet = from->host.ask("pop link=0")) {
        EXPECT_EQ(to.host.askDoubles("push link=0", packet.doubles()).status, 0);
        ++carried;
      }
    }
  }
  EXPECT_EQ(carried, 256);  // 128 per second and user
  EXPECT_GT(second.host.engine.bodies.at(0).state.p_W.x(), 0.1);
  EXPECT_EQ(first.host.read()[kStatus], 0.0);
}

// Codes of `links`: the link's states, and behind them the phases of a mesh's peer.
constexpr double kCalling = 6.0, kDifferent = 8.0, kLeft = 10.0;

// Sealed datagrams over loopback; each step receives, and sends due datagrams.
TEST(TwoUsers, MeetOverAMesh) {
  const std::string key = testing::TempDir() + "tandem_pybullet_pair.key";
  std::remove(key.c_str());
  User first(1, -0.03), second(2, 0.03);
  first.host.command("key path=\"" + key + "\"");
  const int port = 20000 + static_cast<int>(getpid() % 20000);
  const std::string there = "127.0.0.1:" + std::to_string(port);
  for (User* user : {&first, &second}) {
    const bool calls = user == &first;  // the site of the lower number
    user->host.command(std::string(calls ? "peer id=2 address=" + there : "peer id=1") + " key=\"" +
                       key + "\"");
    user->host.command("agree key=object.mass value=0.2");
    user->host.command(calls ? "mesh self=1 bind=127.0.0.1:0" : "mesh self=2 bind=" + there);
    user->host.command(calls ? "link kind=mesh peer=2" : "link kind=mesh peer=1");
  }
  first.connect(2, "0.03,0,0");
  second.connect(1, "-0.03,0,0");
  first.host.command("hand force=5,0,0");
  EXPECT_EQ(first.host.read().back(), kCalling);
  const auto phase = [&] {
    return static_cast<int>(first.host.ask("mesh_status peer=2").doubles().at(0));
  };
  constexpr int kPatience = 20000;  // steps of a millisecond; a handshake takes about ten
  for (int step = 0; step < kPatience && first.host.read()[14] < 20; ++step) {
    first.host.step();
    second.host.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(phase(), TANDEM_PEER_LIVE) << first.host.ask("mesh_explain peer=2").bytes;
  EXPECT_GE(first.host.read()[14], 20);
  EXPECT_LE(first.host.read().back(), TANDEM_LINK_REJOINING);
  second.host.command("close");  // sends BYE
  for (int step = 0; step < kPatience && phase() == TANDEM_PEER_LIVE; ++step) {
    first.host.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(phase(), TANDEM_PEER_LEFT);
  EXPECT_EQ(first.host.read().back(), kLeft);
  std::remove(key.c_str());
}

TEST(TwoUsers, AreNotLiveWithDifferentAgreements) {
  const std::string key = testing::TempDir() + "tandem_pybullet_different.key";
  std::remove(key.c_str());
  User first(1, -0.03), second(2, 0.03);
  first.host.command("key path=\"" + key + "\"");
  const std::string there = "127.0.0.1:" + std::to_string(10000 + getpid() % 10000);
  first.host.command("peer id=2 address=" + there + " key=\"" + key + "\"");
  first.host.command("agree key=object.mass value=0.2");
  first.host.command("mesh self=1 bind=127.0.0.1:0");
  second.host.command("peer id=1 key=\"" + key + "\"");
  second.host.command("agree key=object.mass value=0.3");
  second.host.command("mesh self=2 bind=" + there);
  first.host.command("link kind=mesh peer=2");
  second.host.command("link kind=mesh peer=1");
  first.connect(2, "0.03,0,0");
  second.connect(1, "-0.03,0,0");
  constexpr int kPatience = 20000;
  for (int step = 0; step < kPatience && first.host.read().back() != kDifferent; ++step) {
    EXPECT_NE(first.host.read().back(), TANDEM_LINK_LIVE);
    first.host.step();
    second.host.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(first.host.read().back(), kDifferent);
  EXPECT_NE(first.host.ask("mesh_explain peer=2").bytes.find("object.mass"), std::string::npos);
  std::remove(key.c_str());
}

TEST(TwoUsers, MayLeaveWithALinkOpen) {
  User first(1, -0.03);
  first.host.command("link kind=simulated name=left");
  {
    User second(2, 0.03);
    second.host.closes = false;
    second.host.command("link kind=simulated name=left");
    second.connect(1, "-0.03,0,0");
    second.host.step(5);
  }
  first.connect(2, "0.03,0,0");
  first.host.step(5);
  EXPECT_EQ(first.host.read()[kHasEnded], 0.0);
}

TEST(TwoUsers, ANameIsFreeWhenBothEndsAreBack) {
  PluginHost first, second;
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(first.command("link kind=simulated name=again"), 0);
    EXPECT_EQ(second.command("link kind=simulated name=again"), 0);
    first.command("close");
    second.command("close");
  }
}

}  // namespace
}  // namespace tandem::test
