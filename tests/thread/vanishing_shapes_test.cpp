// A host deletes shapes between its steps, with all memory that they refer to, while a haptic
// thread searches them. ThreadSanitizer and AddressSanitizer watch.

#include <gtest/gtest.h>

#include "bridge/vanishing_shape.h"
#include "thread/live_rig.h"

namespace tandem {
namespace {

using test::LiveSite;
using test::Vanishing;
using test::VanishingFloor;

constexpr HapticLoopSettings kModestLoop{.priority = 0, .locks_memory = false, .begin = {}};

TEST(VanishingShapes, HostDeletesThemAllTheTimeWhileALoopTicks) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0), 2);
  HapticLoop loop(*live.site, kModestLoop);
  std::uint64_t last_ticks = 0;
  for (int round = 0; round < 3 * test::kVanishingKinds; ++round) {
    auto floor =
        std::make_unique<VanishingFloor>(static_cast<Vanishing>(round % test::kVanishingKinds));
    btRigidBody wall(0, nullptr, &floor->shape());
    // Its top touches the cube's side.
    wall.setWorldTransform(
        toBullet(Vec3(0.0, 0.0, -0.0205), test::turn(0.5 * M_PI, Vec3::UnitX())));
    live.rig.world.addRigidBody(&wall);
    live.host(3.0 * LiveSite::kHostPeriod);
    live.rig.world.removeRigidBody(&wall);
    floor.reset();
    // The loop ticks on between two steps of the host.
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::uint64_t ticks = loop.report().ticks;
    EXPECT_GT(ticks, last_ticks);
    last_ticks = ticks;
  }
  loop.stop();
  EXPECT_TRUE(live.watched.is_finite);
  EXPECT_EQ(live.site->status(), kTickOk);
  EXPECT_TRUE(isFinite(live.site->object(0)));
}

}  // namespace
}  // namespace tandem
