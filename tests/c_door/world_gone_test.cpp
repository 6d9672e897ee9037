// A host destroys its Bullet world while the C door still has it. Every call reports this, the dead
// world is never accessed, and handles go in any order that was right before.

#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

TandemWorld* attach(BulletRig& rig) {
  TandemWorld* world = nullptr;
  ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &world));
  return world;
}

TEST(WorldGone, EveryCallSaysSo) {
  auto rig = std::make_unique<BulletRig>();
  LoneDoorProxy door(attach(*rig));
  rig->world.stepSimulation(btScalar(1.0 / 60.0), 0);
  rig.reset();

  EXPECT_TRUE(door.read().status & TANDEM_STATUS_WORLD_GONE);
  TandemState state = makeState(Vec3::Zero());
  const std::vector<std::function<TandemResult()>> calls = {
      [&] { return tandem_world_get_states(door.world, 1, &door.proxy, &state); },
      [&] { return tandem_world_set_state(door.world, door.proxy, &state); },
      [&] { return tandem_world_apply_force(door.world, door.proxy, kNothing, kNothing); },
      [&] { return tandem_world_set_gravity(door.world, kNothing); },
      [&] { return tandem_site_share(door.site, door.proxy, 0.0, nullptr); },
      [&] { return tandem_site_connect(door.site, 3, door.link, kNothing, nullptr); },
      [&] { return tandem_site_start_loop(door.site, 0); },
  };
  for (const auto& call : calls) {
    EXPECT_EQ(call(), TANDEM_WORLD_GONE);
    EXPECT_NE(std::strstr(tandem_last_error(), "destroyed"), nullptr) << tandem_last_error();
  }
}

TEST(WorldGone, IsKnownAfterTheSiteToo) {
  auto rig = std::make_unique<BulletRig>();
  TandemWorld* world = attach(*rig);
  TandemDevice* device = nullptr;
  TandemSite* site = nullptr;
  const TandemSiteSettings settings = tandem_default_site_settings();
  ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
  ok(tandem_site_create(&settings, world, device, &site));
  rig.reset();
  ok(tandem_site_destroy(site));
  EXPECT_EQ(tandem_world_set_gravity(world, kNothing), TANDEM_WORLD_GONE);
  EXPECT_EQ(tandem_site_create(&settings, world, device, &site), TANDEM_WORLD_GONE);
  ok(tandem_world_destroy(world));
  ok(tandem_device_destroy(device));
}

TEST(WorldGone, ForceOfASiteThatIsTickedFades) {
  auto rig = std::make_unique<BulletRig>();
  TandemSiteSettings settings = LoneDoorProxy::makeSettings();
  settings.tick_source = TANDEM_TICK_CALLER;
  DoorSite door(attach(*rig), settings);
  rig.reset();
  std::uint32_t status = 0;
  for (int tick = 0; tick < 100; ++tick) ok(tandem_site_tick(door.site, 1e-3 * tick, &status));
  EXPECT_TRUE(status & TANDEM_STATUS_WORLD_GONE);
  EXPECT_EQ(toVec3(door.read().force), Vec3::Zero());
}

}  // namespace
}  // namespace tandem
