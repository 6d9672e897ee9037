// Threads that share none of our objects must not meet in hidden state of the library.

#include <cstddef>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "bridge/bullet_rig.h"
#include "bullet_bridge/src/world/host_world.h"

namespace tandem {
namespace {

using test::BulletRig;

struct CountingListener final : HostStepListener {
  void beforeHostStep(double) noexcept override { ++steps; }
  void afterHostStep(double) noexcept override {}
  std::size_t steps = 0;
};

TEST(HostWorld, AttachesWorldsInTwoThreadsAtOnce) {
  const auto run = [](std::size_t& count) {
    for (int round = 0; round < 50; ++round) {
      BulletRig rig;
      CountingListener listener;
      const HostWorld attached(rig.world, listener);
      for (int i = 0; i < 20; ++i) rig.step(1e-3);
      count += listener.steps;
    }
  };
  std::size_t first = 0;
  std::size_t second = 0;
  std::thread other(run, std::ref(first));
  run(second);
  other.join();
  EXPECT_EQ(first, 1000u);
  EXPECT_EQ(second, 1000u);
}

}  // namespace
}  // namespace tandem
