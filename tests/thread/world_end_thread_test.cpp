// A host ends its world from its own thread while the haptic thread runs.

#include <chrono>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/link_queue.h"

#include "host/any_host.h"
#include "support/fakes.h"

namespace tandem {
namespace {

TEST(WorldEndsUnderALoop, LetsTheHandGoWhileTheThreadTicksOn) {
  test::AnyHost host(test::WorldKind::kDiscrete, Vec3(0.0, 0.0, -9.81));
  host.addBody(host.makeBox(Vec3(1.0, 1.0, 0.1)), 0.0, Vec3(0.0, 0.0, -0.12));
  btRigidBody& cube = host.addCube(0.2);
  btRigidBody& box = host.addCube(0.1, Vec3(0.041, 0.0, 0.0));
  test::FakeDevice device(Vec3(-0.0295, 0.0, 0.0));
  LinkQueue link;
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  Site site(settings, *host.world, device);
  site.share(cube);
  site.connect(PeerId{2}, link, Vec3(0.0, 0.031, 0.0));
  {
    HapticLoop loop(site, {.priority = 0, .locks_memory = false, .begin = {}});
    for (int i = 0; i < 12; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(8));
      host.step(1.0 / 120.0);
    }
    const auto status = [&] {
      std::uint32_t all = 0;
      site.betweenTicks([&] { all = site.status(); });
      return all;
    };
    EXPECT_EQ(status(), kTickOk);
    host.world.reset();
    EXPECT_EQ(status(), kWorldGone);
    EXPECT_EQ(cube.getMass(), btScalar(0.2));
    EXPECT_EQ(box.getActivationState(), ACTIVE_TAG);
    const std::uint64_t ticks = loop.report().ticks;
    while (loop.report().ticks < ticks + 20) std::this_thread::yield();
    bool is_at_rest = false;
    site.betweenTicks([&] { is_at_rest = site.force() == Vec3::Zero(); });
    EXPECT_TRUE(is_at_rest);
    EXPECT_TRUE(loop.isRunning());
  }
  EXPECT_THROW(HapticLoop(site, {.priority = 0, .locks_memory = false, .begin = {}}), Error);
}

}  // namespace
}  // namespace tandem
