// Objects that go back to the host and are shared again through the C door.

#include <string>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

[[nodiscard]] TandemObjectState stateOf(const DoorSite& site, std::uint32_t object) {
  TandemObjectState state = TANDEM_OBJECT_HELD;
  ok(tandem_site_object_state(site.site, object, &state));
  return state;
}

[[nodiscard]] std::string warningsOf(const DoorSite& site) {
  char text[1024];
  ok(tandem_site_warnings(site.site, text, sizeof text, nullptr));
  return text;
}

/// Two shared cubes in a world of Tandem's, both moving along x.
struct TwoDoorCubes : FreeDoorCube {
  TandemBody second = TANDEM_NO_BODY;

  TwoDoorCubes() : FreeDoorCube(makeWorld()) {
    TandemBodySettings settings = tandem_default_body_settings();
    settings.start = makeState(Vec3(0.0, 1.0, 0.0), Vec3(1.0, 0.0, 0.0));
    ok(tandem_world_add_body(world, &settings, &second));
    ok(tandem_site_share(site, second, 0.0, nullptr));
    steps(1);
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) ok(tandem_world_step(world, 1.0 / 60.0, 0, 0.0));
  }
};

TEST(DoorUnshare, GivesOneBackAndTakesAnother) {
  TwoDoorCubes cubes;
  EXPECT_EQ(tandem_world_remove_body(cubes.world, cubes.second), TANDEM_IN_USE);
  ok(tandem_site_unshare(cubes.site, 1));
  ok(tandem_site_unshare(cubes.site, 1));  // again: nothing happens
  EXPECT_EQ(stateOf(cubes, 1), TANDEM_OBJECT_UNSHARED);
  EXPECT_EQ(stateOf(cubes, 0), TANDEM_OBJECT_HELD);
  cubes.steps(2);
  EXPECT_NEAR(cubes.body(cubes.second).velocity[0], 1.0, byDoorWidth(1e-9, 1e-6));
  ok(tandem_world_remove_body(cubes.world, cubes.second));
  cubes.steps(2);
  EXPECT_EQ(cubes.read().status, 0u);

  TandemBodySettings settings = tandem_default_body_settings();
  settings.shape = TANDEM_CONE;
  settings.size[0] = 0.02, settings.size[1] = 0.05;
  settings.start = makeState(Vec3(0.0, 2.0, 0.0));
  TandemBody cone = TANDEM_NO_BODY;
  ok(tandem_world_add_body(cubes.world, &settings, &cone));
  ok(tandem_site_share_again(cubes.site, 1, cone));
  cubes.steps(2);
  EXPECT_EQ(stateOf(cubes, 1), TANDEM_OBJECT_HELD);
  EXPECT_NEAR(cubes.object(1).position[1], 2.0, 1e-6);
  EXPECT_EQ(cubes.read().object_count, 2u);
}

// Half of the new mass acts from the next step on: J = 0.02 N s on 0.5 kg.
TEST(DoorDynamics, AreFollowedByASharedBody) {
  TwoDoorCubes cubes;
  const TandemDynamics heavy{1.0, {0.0, 0.0, 0.0}, 0.9, 0.1, 0.001, 0.0};
  ok(tandem_world_set_dynamics(cubes.world, cubes.cube, &heavy));
  cubes.steps(2);
  EXPECT_EQ(stateOf(cubes, 0), TANDEM_OBJECT_HELD);
  const double force[3] = {0.02 * 60.0, 0.0, 0.0};
  ok(tandem_world_apply_force(cubes.world, cubes.cube, force, nullptr));
  cubes.steps(2);
  // Parts of a tick are made up for later; with the old mass it were 0.2 m/s.
  EXPECT_NEAR(cubes.body(cubes.cube).velocity[0], 0.04, 1e-4);
  EXPECT_NEAR(cubes.body(cubes.second).velocity[0], 1.0, byDoorWidth(1e-9, 1e-6));

  const TandemDynamics none{0.0, {0.0, 0.0, 0.0}, 0.5, 0.0, 0.0, 0.0};
  EXPECT_EQ(tandem_world_set_dynamics(cubes.world, cubes.cube, &none), TANDEM_INVALID_ARGUMENT);
  EXPECT_NE(std::string(tandem_last_error()).find("mass = 0: must be above 0"), std::string::npos)
      << tandem_last_error();
}

// A host that removes a shared body is told which one, and what to do.
TEST(DoorUnshare, NamesTheObjectThatIsMissing) {
  BulletRig rig;
  TandemWorld* world = nullptr;
  ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &world));
  DoorSite of(world, FreeDoorCube::makeSettings());
  btRigidBody& cube = rig.addCube(0.2, 0.02, Vec3::Zero());
  TandemBody body = TANDEM_NO_BODY;
  ok(tandem_world_find_body(world, &cube, &body));
  ok(tandem_site_share(of.site, body, 0.0, nullptr));
  rig.world.stepSimulation(btScalar(1.0 / 60.0), 0);
  rig.world.removeRigidBody(&cube);
  rig.world.stepSimulation(btScalar(1.0 / 60.0), 0);
  EXPECT_EQ(stateOf(of, 0), TANDEM_OBJECT_MISSING);
  EXPECT_EQ(of.read().status, static_cast<std::uint32_t>(TANDEM_STATUS_BODY_MISSING));
  EXPECT_NE(warningsOf(of).find("object 0 is not in the Bullet world"), std::string::npos);

  btRigidBody& other = rig.addCube(0.4, 0.02, Vec3(0.0, 0.0, 1.0));
  TandemBody another = TANDEM_NO_BODY;
  ok(tandem_world_find_body(world, &other, &another));
  ok(tandem_site_share_again(of.site, 0, another));
  rig.world.stepSimulation(btScalar(1.0 / 60.0), 0);
  EXPECT_EQ(stateOf(of, 0), TANDEM_OBJECT_HELD);
  EXPECT_EQ(warningsOf(of), "");

  other.setCollisionFlags(other.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
  rig.world.stepSimulation(btScalar(1.0 / 60.0), 0);
  EXPECT_EQ(stateOf(of, 0), TANDEM_OBJECT_LEFT);
  EXPECT_NE(warningsOf(of).find("object 0 is left to Bullet"), std::string::npos);
}

// A host's whole world is moved: no force, and no velocity.
TEST(DoorOrigin, IsShiftedWithTheHostsWorld) {
  BulletRig rig;
  TandemWorld* world = nullptr;
  ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &world));
  DoorSite of(world, FreeDoorCube::makeSettings());
  btRigidBody& cube = rig.addCube(0.2, 0.02, Vec3::Zero());
  TandemBody body = TANDEM_NO_BODY;
  ok(tandem_world_find_body(world, &cube, &body));
  ok(tandem_site_share(of.site, body, 0.0, nullptr));
  rig.step(1.0 / 60.0);
  const double offset[3] = {64.0, 0.0, 0.0};
  cube.setCenterOfMassTransform(toBullet(Vec3(64.0, 0.0, 0.0), Quat::Identity()));
  ok(tandem_site_shift_origin(of.site, offset));
  rig.step(1.0 / 60.0);
  EXPECT_EQ(of.object().position[0], 64.0);
  EXPECT_EQ(of.object().velocity[0], 0.0);
  EXPECT_EQ(cube.getCenterOfMassPosition().x(), btScalar(64.0));
}

}  // namespace
}  // namespace tandem
