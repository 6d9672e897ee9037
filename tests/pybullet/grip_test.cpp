// A hand that holds a body of PyBullet's.

#include <gtest/gtest.h>

#include "plugin_rig.h"

namespace tandem {
namespace {

using namespace test;

// Indices in the answer of `grip`.
constexpr std::size_t kObject = 0, kFading = 1, kAt = 2, kForce = 5, kGripSize = 11;

/// A cube of 0.2 kg in the air, at a hand.
struct HeldCube {
  PluginHost host;
  int cube;

  HeldCube() {
    StubBody body = makeStubCube();
    body.state.p_W = Vec3(0.0, 0.0, 0.5);
    cube = host.engine.add(body);
    host.engine.gravity = Vec3(0, 0, -9.81);
    host.command("device kind=moved start=0,0,0.53");
    host.command("site peers=1 grip_lift_time=0.1");
    host.command("share body=" + std::to_string(cube));
  }
  void step(int count) {
    for (int i = 0; i < count; ++i) {
      host.command("hand position=0,0,0.53 velocity=0,0,0");
      host.step(1);
    }
  }
  std::vector<double> grip() { return host.ask("grip").doubles(); }
};

TEST(HeldBody, HangsAtTheHandAndFalls) {
  HeldCube held;
  EXPECT_TRUE(held.grip().empty());
  held.host.command("grab object=0 at=0,0,0.03");
  held.step(500);
  const std::vector<double> grip = held.grip();
  ASSERT_EQ(grip.size(), kGripSize);
  EXPECT_EQ(grip[kObject], 0.0);
  EXPECT_EQ(grip[kFading], 0.0);
  EXPECT_EQ(grip[kAt + 2], 0.03);
  EXPECT_NEAR(grip[kForce + 2], 9.81 * held.host.engine.bodies.at(held.cube).mass, 1e-3);
  EXPECT_NEAR(held.host.engine.bodies.at(held.cube).state.p_W.z(), 0.5, 1e-3);
  held.host.command("release");
  held.step(60);
  EXPECT_TRUE(held.grip().empty());
  EXPECT_LT(held.host.engine.bodies.at(held.cube).state.p_W.z(), 0.49);
}

TEST(HeldBody, IsRefusedWithTheReason) {
  HeldCube held;
  EXPECT_NE(held.host.refusal("grab object=7").find("no object 7"), std::string::npos);
  EXPECT_NE(held.host.refusal("grab object=0 at=0,0").find("at"), std::string::npos);
  held.host.command("unshare object=0");
  EXPECT_NE(held.host.refusal("grab object=0").find("not shared"), std::string::npos);
  held.host.command("close");
  EXPECT_FALSE(held.host.refusal("grab object=0").empty());
  EXPECT_FALSE(held.host.refusal("release").empty());
  EXPECT_FALSE(held.host.refusal("grip").empty());
}

// Ten doubles more at the end of a packet.
TEST(HeldBody, GoesWithPackets) {
  HeldCube held;
  const int link = held.host.command("link kind=manual");
  held.host.command("connect peer=2 start=5,0,0 link=" + std::to_string(link));
  const std::string words = " link=" + std::to_string(link);
  held.host.command("grab object=0");
  held.step(4);
  std::vector<double> packet = held.host.ask("pop" + words).doubles();
  const std::size_t end = 13 + 16 * static_cast<std::size_t>(packet.at(12));
  ASSERT_EQ(packet.size(), end + 10);
  EXPECT_EQ(packet[end], 1.0);      // epoch
  EXPECT_EQ(packet[end + 1], 0.0);  // object
  EXPECT_NEAR(packet[end + 4], 0.03, 1e-6);
  EXPECT_EQ(packet[end + 8], 1.0);
  packet[0] = 2;
  EXPECT_EQ(held.host.askDoubles("push" + words, packet).status, 0);
  packet[end + 1] = -1.0;
  EXPECT_EQ(held.host.askDoubles("push" + words, packet).status, 0);
  packet[end + 1] = 0.5;
  EXPECT_LT(held.host.askDoubles("push" + words, packet).status, 0);
  packet.pop_back();
  EXPECT_LT(held.host.askDoubles("push" + words, packet).status, 0);
}

TEST(HeldBody, IsAToolThatTurns) {
  HeldCube held;
  StubBody body = makeStubCube();
  body.state.p_W = Vec3(0.0, 0.3, 0.5);
  const int tool = held.host.engine.add(body);
  EXPECT_EQ(held.host.command("share body=" + std::to_string(tool) + " tool_of=1"), 1);
  const double mass = held.host.engine.bodies.at(tool).mass;
  for (int i = 0; i < 500; ++i) {
    held.host.command(std::string("hand position=0,0.3,0.53 velocity=0,0,0 orientation=") +
                      (i < 10 ? "0,0,0,1" : "0,0,0.6,0.8"));
    held.host.step(1);
  }
  const RigidState& state = held.host.engine.bodies.at(tool).state;
  EXPECT_LT((state.p_W - Vec3(0.0, 0.3, 0.53)).norm(), 1e-3);
  EXPECT_NEAR(std::abs(state.q_WB.z()), 0.6, 1e-3);
  EXPECT_EQ(held.host.engine.bodies.at(tool).mass, mass);  // whole
  EXPECT_EQ(held.grip()[kObject], 1.0);
  EXPECT_FALSE(held.host.refusal("share body=0 tool_of=0").empty());
}

}  // namespace
}  // namespace tandem
