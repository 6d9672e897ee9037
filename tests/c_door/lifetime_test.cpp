// Handles are destroyed in any order. One still in use is refused, and none is lost or freed twice.

#include <algorithm>
#include <numeric>

#include "bridge/bullet_rig.h"
#include "c_door/c_door_rig.h"

namespace tandem {
namespace {

using namespace test;

/// Two sites with all their parts.
class Everything {
 public:
  Everything() {
    const TandemNetwork network{};
    ok(tandem_link_create_simulated(&network, &links_[0], &links_[1]));
    for (std::uint32_t i = 0; i < 2; ++i) {
      TandemSiteSettings settings = tandem_default_site_settings();
      settings.self = i + 1;
      const TandemBodySettings cube = tandem_default_body_settings();
      TandemBody body = TANDEM_NO_BODY;
      worlds_[i] = makeWorld();
      ok(tandem_world_add_body(worlds_[i], &cube, &body));
      ok(tandem_device_create_moved(kFarAway, kAnyForce, &devices_[i]));
      ok(tandem_site_create(&settings, worlds_[i], devices_[i], &sites_[i]));
      ok(tandem_site_share(sites_[i], body, 0.0, nullptr));
      ok(tandem_site_connect(sites_[i], 2 - i, links_[i], kFarAway, nullptr));
    }
    step();
  }

  void step() {
    for (TandemWorld* world : worlds_)
      if (world) ok(tandem_world_step(world, 1.0 / 60.0, 0, 0.0));
  }

  static constexpr std::size_t kHandles = 8;

  /// Destroys handle 0 to 7: two sites, worlds, devices, links.
  TandemResult destroy(std::size_t handle) {
    const std::size_t i = handle % 2;
    switch (handle / 2) {
      case 0:
        return forget(sites_[i], tandem_site_destroy(sites_[i]));
      case 1:
        return forget(worlds_[i], tandem_world_destroy(worlds_[i]));
      case 2:
        return forget(devices_[i], tandem_device_destroy(devices_[i]));
      default:
        return forget(links_[i], tandem_link_destroy(links_[i]));
    }
  }
  [[nodiscard]] bool isNeeded(std::size_t handle) const {
    return handle >= 2 && sites_[handle % 2] != nullptr;
  }

 private:
  template <typename Handle>
  static TandemResult forget(Handle*& handle, TandemResult result) {
    if (result == TANDEM_OK) handle = nullptr;
    return result;
  }

  TandemWorld* worlds_[2]{};
  TandemDevice* devices_[2]{};
  TandemLink* links_[2]{};
  TandemSite* sites_[2]{};
};

/// Destroys in the given order. A handle in use is refused, stays whole, and goes in a second
/// round.
void destroyInOrder(const std::array<std::size_t, Everything::kHandles>& order) {
  Everything all;
  for (const std::size_t handle : order) {
    const bool is_needed = all.isNeeded(handle);
    ASSERT_EQ(all.destroy(handle), is_needed ? TANDEM_IN_USE : TANDEM_OK) << handle;
    all.step();
  }
  for (std::size_t handle = 0; handle < Everything::kHandles; ++handle) ok(all.destroy(handle));
}

// Both sites are alike, so orders that begin with the second site's handles are skipped. Of 8!
// orders, the 20160 with handle 0 before handle 1 remain.
TEST(Lifetime, AnyOrderOfDestroying) {
  std::array<std::size_t, Everything::kHandles> order{};
  std::iota(order.begin(), order.end(), 0);
  std::size_t number = 0;
  do {
    const bool is_mirrored =
        std::find(order.begin(), order.end(), 1u) < std::find(order.begin(), order.end(), 0u);
    // Takes every 101st order. 101 does not divide 8!, so all handles come in all places.
    if (is_mirrored || ++number % 101 != 0) continue;
    destroyInOrder(order);
    if (HasFatalFailure()) return;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_GT(number, 20000u);
}

// One site with each of its four handles: all 24 orders.
TEST(Lifetime, AnyOrderForOneSite) {
  std::array<int, 4> order{0, 1, 2, 3};
  do {
    TandemWorld* world = makeWorld();
    TandemDevice* device = nullptr;
    TandemLink* link = nullptr;
    TandemSite* site = nullptr;
    const TandemSiteSettings settings = tandem_default_site_settings();
    ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
    ok(tandem_link_create_manual(&link));
    ok(tandem_site_create(&settings, world, device, &site));
    ok(tandem_site_connect(site, 2, link, kFarAway, nullptr));
    ok(tandem_world_step(world, 1.0 / 60.0, 0, 0.0));
    bool is_gone = false;
    const auto destroy = [&](int which) {
      switch (which) {
        case 0:
          is_gone = true;
          return tandem_site_destroy(site);
        case 1:
          return tandem_world_destroy(world);
        case 2:
          return tandem_device_destroy(device);
        default:
          return tandem_link_destroy(link);
      }
    };
    std::vector<int> left;
    for (const int which : order) {
      const TandemResult result = destroy(which);
      EXPECT_EQ(result, is_gone ? TANDEM_OK : TANDEM_IN_USE) << which;
      if (result != TANDEM_OK) left.push_back(which);
    }
    for (const int which : left) ok(destroy(which));
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Lifetime, WhatWasDestroyedIsKnownAsGone) {
  TandemWorld* world = makeWorld();
  ok(tandem_world_destroy(world));
  // Many worlds are made in between.
  for (int i = 0; i < 200; ++i) ok(tandem_world_destroy(makeWorld()));
  EXPECT_EQ(tandem_world_step(world, 0.1, 0, 0.0), TANDEM_INVALID_ARGUMENT);
  EXPECT_EQ(tandem_world_destroy(world), TANDEM_INVALID_ARGUMENT);
}

// A site returns the host's world, and another site may attach to it.
TEST(Lifetime, AHostsWorldIsGivenBack) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.2);
  for (int round = 0; round < 3; ++round) {
    TandemWorld* world = nullptr;
    ok(tandem_world_attach(&rig.world, TANDEM_ATTACH_ABI, &world));
    TandemBody body = TANDEM_NO_BODY, again = TANDEM_NO_BODY;
    ok(tandem_world_find_body(world, &cube, &body));
    ok(tandem_world_find_body(world, &cube, &again));
    EXPECT_EQ(body, again);
    DoorSite site(world, tandem_default_site_settings());
    ok(tandem_site_share(site.site, body, 0.0, nullptr));
    rig.step(1.0 / 60.0);
    EXPECT_EQ(static_cast<double>(cube.getMass()), static_cast<double>(btScalar(0.1)));
    EXPECT_EQ(rig.world.getNumCollisionObjects(), 1);
  }
  EXPECT_EQ(static_cast<double>(cube.getMass()), static_cast<double>(btScalar(0.2)));
  EXPECT_EQ(rig.world.getNumCollisionObjects(), 1);
}

// No resource was attached that could be missed.
TEST(Lifetime, AProxyIsABodyUntilItsSiteEnds) {
  TandemWorld* world = makeWorld();
  TandemBody proxy = TANDEM_NO_BODY;
  TandemState state{};
  TandemDevice* device = nullptr;
  TandemLink* link = nullptr;
  TandemSite* site = nullptr;
  const TandemSiteSettings settings = tandem_default_site_settings();
  ok(tandem_device_create_moved(kFarAway, kAnyForce, &device));
  ok(tandem_link_create_manual(&link));
  ok(tandem_site_create(&settings, world, device, &site));
  ok(tandem_site_connect(site, 2, link, kFarAway, &proxy));
  ok(tandem_world_get_states(world, 1, &proxy, &state));
  EXPECT_EQ(state.position[0], kFarAway[0]);
  ok(tandem_site_destroy(site));
  EXPECT_EQ(tandem_world_get_states(world, 1, &proxy, &state), TANDEM_INVALID_ARGUMENT);
  ok(tandem_world_destroy(world));
  ok(tandem_device_destroy(device));
  ok(tandem_link_destroy(link));
}

// A scheme without a body for the remote user has no proxy.
TEST(Lifetime, SomeSchemesHaveNoProxy) {
  TandemSiteSettings settings = tandem_default_site_settings();
  settings.scheme = "virtual_coupling";
  const DoorSite site(makeWorld(), settings);
  TandemBody proxy = 77;
  ok(tandem_site_connect(site.site, 2, site.link, kFarAway, &proxy));
  EXPECT_EQ(proxy, TANDEM_NO_BODY);
  TandemState state = makeState(Vec3::Zero());
  ok(tandem_site_read(site.site, nullptr, 0, nullptr, 1, &state, nullptr));
  EXPECT_TRUE(std::isnan(state.position[0]));
}

}  // namespace
}  // namespace tandem
