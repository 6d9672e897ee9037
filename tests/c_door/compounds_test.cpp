// Bodies of several shapes in a world of Tandem's.

#include <vector>

#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

TandemShapePart makePart(TandemShapeKind kind, const Vec3& size, const Vec3& position) {
  TandemShapePart part{};
  part.shape = kind;
  for (int i = 0; i < 3; ++i) part.size[i] = size[i], part.position[i] = position[i];
  part.orientation[3] = 1.0;
  return part;
}

// The hand presses each arm of a heavy L, and feels nothing between them.
TEST(DoorCompounds, AreSharedAndFelt) {
  TandemWorld* world = makeWorld();
  TandemBodySettings settings = tandem_default_body_settings();
  settings.mass = 1e9;
  const std::vector<TandemShapePart> parts{
      makePart(TANDEM_BOX, {0.1, 0.01, 0.03}, {0.0, 0.0, 0.0}),
      makePart(TANDEM_CYLINDER, {0.01, 0.06, 0.0}, {-0.09, 0.06, 0.0}),  // along z
      makePart(TANDEM_BOX, {0.01, 0.05, 0.03}, {0.09, 0.06, 0.0})};
  TandemBody body = TANDEM_NO_BODY;
  ok(tandem_world_add_compound(world, &settings, parts.size(), parts.data(), &body));
  TandemDevice* device = nullptr;
  const double start[3] = {0.0, 0.06, 0.0};
  ok(tandem_device_create_moved(start, {1e3, 1e9}, &device));
  TandemSiteSettings site_settings = tandem_default_site_settings();
  site_settings.peers = 1;
  site_settings.contact = {2000.0, 0.0};
  TandemSite* site = nullptr;
  ok(tandem_site_create(&site_settings, world, device, &site));
  ok(tandem_site_share(site, body, 0.0, nullptr));
  Vec3 hand(0.0, 0.06, 0.0);
  // The hand goes there in half a second, and stays for another.
  const auto press = [&](const Vec3& to) {
    const Vec3 step = (to - hand) / 120, v = 240.0 * step;
    const double still[3] = {};
    for (int i = 0; i < 240; ++i) {
      if (i < 120) hand += step;
      ok(tandem_device_move(device, hand.data(), i < 119 ? v.data() : still));
      ok(tandem_world_step(world, 1.0 / 240.0, 0, 0.0));
    }
    double force[3];
    ok(tandem_device_get_force(device, force));
    return Vec3(force[0], force[1], force[2]);
  };
  const double rounding = byDoorWidth(1e-4, 1e-2);
  EXPECT_LT((press({0.0, 0.018, 0.0}) - Vec3(0.0, 4.0, 0.0)).norm(), rounding);
  EXPECT_EQ(press({0.0, 0.06, 0.0}), Vec3::Zero());
  EXPECT_LT((press({-0.072, 0.06, 0.0}) - Vec3(4.0, 0.0, 0.0)).norm(), rounding);
  EXPECT_LT((press({0.072, 0.06, 0.0}) - Vec3(-4.0, 0.0, 0.0)).norm(), rounding);
  ok(tandem_site_destroy(site));
  ok(tandem_world_destroy(world));
  ok(tandem_device_destroy(device));
}

}  // namespace
}  // namespace tandem
