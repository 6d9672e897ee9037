// A host's thread grabs and releases while a haptic thread ticks.

#include <thread>

#include <gtest/gtest.h>

#include "thread/live_rig.h"

namespace tandem {
namespace {

using test::LiveSite;
using test::Wire;

TEST(GripThread, HostsGrabWhileLoopsTick) {
  constexpr HapticLoopSettings kModest{.priority = 0, .locks_memory = false, .begin = {}};
  LiveSite one(1, Vec3(0.0, 2.0, 0.0)), two(2, Vec3(-1.0, 0.0, 0.0));
  {
    const Wire wire(one.queue, two.queue);
    HapticLoop loop_one(*one.site, kModest), loop_two(*two.site, kModest);
    const auto play = [](LiveSite& live, double pause) {
      for (int i = 0; i < 8; ++i) {
        live.site->grab(0);
        live.host(0.15);
        std::optional<Grip> grip;
        live.site->betweenTicks([&] { grip = live.site->grip(); });
        EXPECT_TRUE(grip && !grip->is_fading);
        live.site->release();
        live.host(pause);
      }
    };
    std::thread other([&] { play(two, 0.11); });
    play(one, 0.07);
    other.join();
  }
  for (const LiveSite* live : {&one, &two}) {
    EXPECT_TRUE(live->watched.is_finite);
    EXPECT_EQ(live->site->status(), kTickOk);
    EXPECT_TRUE(isFinite(live->site->object(0)));
    EXPECT_GE(live->site->latest(0).grip->epoch, 8u);
  }
}

}  // namespace
}  // namespace tandem
