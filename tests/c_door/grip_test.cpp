// A hand that holds a shared body, through the C door.

#include <cmath>
#include <string>

#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

constexpr double kStep = 1.0 / 60.0;
constexpr double kWeight = 9.81;  // [N/kg]

/// A hand that lifts a cube of 0.2 kg off nothing: it falls unless it is held.
struct HeldCube : FreeDoorCube {
  explicit HeldCube(const TandemSiteSettings& settings = makeSettings())
      : FreeDoorCube(makeWorld(), 0.2, settings) {
    const double gravity[3] = {0.0, 0.0, -kWeight};
    ok(tandem_world_set_gravity(world, gravity));
    hold(Vec3(0.0, 0.0, 0.03));
  }
  void hold(const Vec3& p_W) {
    const double place[3] = {p_W.x(), p_W.y(), p_W.z()}, speed[3] = {0.0, 0.0, 0.0};
    ok(tandem_device_move(device, place, speed));
  }
  void steps(int count, const Vec3& p_W) {
    for (int i = 0; i < count; ++i) {
      hold(p_W);
      ok(tandem_world_step(world, kStep, 0, 0.0));
    }
  }
  [[nodiscard]] TandemGrip grip() const {
    TandemGrip grip{};
    ok(tandem_site_read_grip(site, &grip));
    return grip;
  }
};

TEST(DoorGrip, HoldsAndLetsGo) {
  HeldCube cube;
  EXPECT_EQ(cube.grip().object, TANDEM_NO_OBJECT);
  const Vec3 hand_W(0.0, 0.0, 0.03);
  const double at[3] = {0.0, 0.0, 0.03};
  ok(tandem_site_grab(cube.site, 0, at));
  cube.steps(180, hand_W);
  const TandemGrip held = cube.grip();
  EXPECT_EQ(held.object, 0u);
  EXPECT_EQ(held.is_fading, 0);
  EXPECT_EQ(held.at[2], 0.03);
  EXPECT_NEAR(held.force[2], 0.5 * 0.2 * kWeight, 1e-4);  // the copy's half
  EXPECT_NEAR(cube.object().position[2], 0.0, 1e-4);
  EXPECT_NEAR(cube.read().force[2], -held.force[2], 1e-6);
  ok(tandem_site_release(cube.site));
  EXPECT_EQ(cube.grip().is_fading, 1);
  cube.steps(30, hand_W);
  EXPECT_EQ(cube.grip().object, TANDEM_NO_OBJECT);
  EXPECT_LT(cube.object().position[2], -0.5);
  ok(tandem_site_release(cube.site));  // again: nothing happens
}

TEST(DoorGrip, IsRefusedWithTheReason) {
  HeldCube cube;
  const double bad[3] = {0.0, std::nan(""), 0.0};
  EXPECT_EQ(tandem_site_grab(cube.site, 3, nullptr), TANDEM_INVALID_ARGUMENT);
  EXPECT_NE(std::string(tandem_last_error()).find("no object 3"), std::string::npos);
  EXPECT_EQ(tandem_site_grab(cube.site, 0, bad), TANDEM_INVALID_ARGUMENT);
  EXPECT_EQ(tandem_site_read_grip(cube.site, nullptr), TANDEM_INVALID_ARGUMENT);
  ok(tandem_site_unshare(cube.site, 0));
  EXPECT_EQ(tandem_site_grab(cube.site, 0, nullptr), TANDEM_CANNOT);
  EXPECT_EQ(tandem_site_grab(nullptr, 0, nullptr), TANDEM_INVALID_ARGUMENT);
  EXPECT_EQ(tandem_site_release(nullptr), TANDEM_INVALID_ARGUMENT);
}

// Sites that follow who is there tell each other, by the caller's packets too.
TEST(DoorRoll, GoesWithPackets) {
  TandemSiteSettings settings = HeldCube::makeSettings();
  settings.membership_follows = 1;
  HeldCube cube(settings);
  ok(tandem_site_connect(cube.site, 2, cube.link, kFarAway, nullptr));
  cube.steps(2, Vec3(0.0, 0.0, 0.03));
  TandemPacket packet{};
  int there = 0;
  ok(tandem_link_pop(cube.link, &packet, &there));
  ASSERT_TRUE(there);
  EXPECT_EQ(packet.roll_heard, 1u);
  EXPECT_EQ(packet.roll_members, 1u);
  packet.sender = 2;
  packet.roll_heard = 3;
  packet.roll_members = 2;
  ok(tandem_link_push(cube.link, &packet));
  cube.steps(4, Vec3(0.0, 0.0, 0.03));
  do ok(tandem_link_pop(cube.link, &packet, &there));
  while (there);
  EXPECT_EQ(packet.roll_members, 3u);
}

// What one site's packet tells of a grip, another site takes in.
TEST(DoorGrip, GoesWithPackets) {
  HeldCube cube;
  ok(tandem_site_connect(cube.site, 2, cube.link, kFarAway, nullptr));
  ok(tandem_site_grab(cube.site, 0, nullptr));
  cube.steps(2, Vec3(0.0, 0.0, 0.03));
  TandemPacket packet{};
  int there = 0;
  ok(tandem_link_pop(cube.link, &packet, &there));
  ASSERT_TRUE(there);
  EXPECT_EQ(packet.has_grip, 1);
  EXPECT_EQ(packet.grip_epoch, 1u);
  EXPECT_EQ(packet.grip_object, 0u);
  EXPECT_NEAR(packet.grip_position[2], 0.03, 1e-4);
  EXPECT_EQ(packet.grip_orientation[3], 1.0);

  packet.sender = 2;
  packet.grip_orientation[3] = 0.5;  // no unit: the packet is refused
  ok(tandem_link_push(cube.link, &packet));
  cube.steps(1, Vec3(0.0, 0.0, 0.03));
  EXPECT_EQ(cube.read().status, std::uint32_t{TANDEM_STATUS_PACKET_REFUSED});
  EXPECT_EQ(cube.read().packets_taken, 0u);
  packet.grip_orientation[3] = 1.0;
  packet.sequence = 1;
  ok(tandem_link_push(cube.link, &packet));
  cube.steps(1, Vec3(0.0, 0.0, 0.03));
  EXPECT_EQ(cube.read().packets_taken, 1u);
}

/// A stick that user 1 has as a tool, beside the shared cube.
struct ToolInHand : HeldCube {
  std::uint32_t tool = 99;

  ToolInHand() {
    TandemBodySettings stick = tandem_default_body_settings();
    stick.size[0] = stick.size[1] = 0.01;
    stick.size[2] = 0.06;
    stick.mass = 0.05;
    stick.start.position[0] = 0.5;
    TandemBody body = TANDEM_NO_BODY;
    ok(tandem_world_add_body(world, &stick, &body));
    ok(tandem_site_share_tool(site, body, 1, nullptr, &tool));
  }
  [[nodiscard]] TandemState toolState() const {
    TandemReading reading{};
    TandemState objects[2];
    ok(tandem_site_read(site, &reading, 2, objects, 0, nullptr, nullptr));
    return objects[1];
  }
};

TEST(DoorGrip, AToolComesToTheHandAndTurnsWithIt) {
  ToolInHand held;
  EXPECT_EQ(held.tool, 1u);
  const double half = std::sqrt(0.5), turned[4] = {0, 0, half, half}, rate[3] = {0, 0, 0};
  const double straight[4] = {0, 0, 0, 1};
  ok(tandem_device_turn(held.device, straight, rate));
  held.steps(10, Vec3(0.5, 0.2, 0.0));
  ok(tandem_device_turn(held.device, turned, rate));
  held.steps(120, Vec3(0.5, 0.2, 0.0));
  EXPECT_EQ(held.grip().object, held.tool);
  const TandemState tool = held.toolState();
  EXPECT_NEAR(tool.position[1], 0.2, 1e-4);
  EXPECT_NEAR(std::abs(tool.orientation[2]), half, 1e-4);
  EXPECT_NEAR(held.read().force[2], -0.05 * kWeight, 1e-3);
}

TEST(DoorGrip, AToolIsRefusedWithTheReason) {
  ToolInHand held;
  TandemBodySettings settings = tandem_default_body_settings();
  TandemBody body = TANDEM_NO_BODY;
  settings.mass = 0.1;
  ok(tandem_world_add_body(held.world, &settings, &body));
  EXPECT_EQ(tandem_site_share_tool(held.site, body, 1, nullptr, nullptr), TANDEM_CANNOT);
  EXPECT_NE(std::string(tandem_last_error()).find("release it first"), std::string::npos);
  const double bad[4] = {0, 0, 0, 2}, rate[3] = {0, 0, 0};
  EXPECT_EQ(tandem_device_turn(held.device, bad, rate), TANDEM_INVALID_ARGUMENT);
  std::uint32_t theirs = 0;
  ok(tandem_site_share_tool(held.site, body, 2, nullptr, &theirs));
  EXPECT_EQ(tandem_site_grab(held.site, theirs, nullptr), TANDEM_CANNOT);
}

}  // namespace
}  // namespace tandem
