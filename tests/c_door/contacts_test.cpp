// Points of contact with forces, read through the C door.

#include <vector>

#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

// A sphere rests on a table: one point, which carries its weight.
TEST(DoorContacts, CarryTheWeight) {
  TandemWorld* world = makeWorld();
  const double gravity[3] = {0.0, 0.0, -9.81};
  ok(tandem_world_set_gravity(world, gravity));
  TandemBodySettings settings = tandem_default_body_settings();
  settings.shape = TANDEM_SPHERE;
  settings.size[0] = 0.02;
  settings.start = makeState(Vec3(0.0, 0.0, 0.02));
  TandemBody ball = TANDEM_NO_BODY, table = TANDEM_NO_BODY;
  ok(tandem_world_add_body(world, &settings, &ball));
  settings.shape = TANDEM_PLANE;
  settings.mass = 0.0;
  settings.start = makeState(Vec3::Zero());
  ok(tandem_world_add_body(world, &settings, &table));

  std::size_t count = 7;
  ok(tandem_world_get_contacts(world, 0, nullptr, &count));
  EXPECT_EQ(count, 0u);
  for (int i = 0; i < 120; ++i) ok(tandem_world_step(world, 1.0 / 240.0, 0, 0.0));
  std::vector<TandemContact> contacts(4);
  ok(tandem_world_get_contacts(world, contacts.size(), contacts.data(), &count));
  ASSERT_EQ(count, 1u);
  const TandemContact& contact = contacts[0];
  const double up = contact.a == ball ? 1.0 : -1.0;
  EXPECT_EQ(contact.a == ball ? contact.b : contact.a, table);
  EXPECT_NEAR(contact.normal[2], up, 1e-6);
  EXPECT_NEAR(contact.distance, 0.0, 1e-3);
  EXPECT_NEAR(contact.force, 0.2 * 9.81, 0.01);
  EXPECT_NEAR(toVec3(contact.friction).norm(), 0.0, 0.01);
  EXPECT_EQ(tandem_world_get_contacts(world, 1, nullptr, &count), TANDEM_INVALID_ARGUMENT);
  ok(tandem_world_destroy(world));
}

}  // namespace
}  // namespace tandem
