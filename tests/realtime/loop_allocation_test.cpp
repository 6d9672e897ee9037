// The haptic thread of a live site neither allocates nor locks. Meanwhile the host's thread steps
// its world, and finds floors and boxes that come near.

#include <mutex>
#include <optional>

#include <gtest/gtest.h>

#include "realtime/allocation_count.h"
#include "realtime/lock_count.h"
#include "thread/live_rig.h"

namespace tandem {
namespace {

TEST(HapticThread, TakesNothingFromTheHeapAndNoLock) {
  test::AllocationCount::watchBullet();
  test::LiveSite live(1, Vec3(0.0, 2.0, 0.0)), far(2, Vec3::Zero());
  btRigidBody& comer = live.rig.addCube(0.2, 0.02, Vec3(0.06, -0.5, 0.0));
  comer.setLinearVelocity(btVector3(0, 3, 0));
  const test::Wire wire(live.queue, far.queue);
  HapticLoop far_loop(*far.site, {.priority = 0, .locks_memory = false, .begin = {}});
  HapticLoop loop(*live.site, {.priority = 0, .locks_memory = false, .begin = {}});

  std::optional<test::AllocationCount> allocations;
  std::optional<test::LockCount> locks;
  std::uint64_t promoted = 0, arrived = 0, ticks = 0;
  std::size_t allocated = 0, locked = 0;
  live.site->betweenTicks([&] {
    promoted = live.site->counters().promoted;
    arrived = live.site->counters().packets_taken;
    ticks = live.site->tickCount();
    allocations.emplace();
    locks.emplace();
  });
  live.host(1.5);
  live.site->betweenTicks([&] {
    allocated = allocations->count();
    locked = locks->count();
    allocations.reset();
    locks.reset();
    promoted = live.site->counters().promoted - promoted;
    arrived = live.site->counters().packets_taken - arrived;
    ticks = live.site->tickCount() - ticks;
  });
  loop.stop();
  far_loop.stop();
  EXPECT_EQ(allocated, 0u);
  EXPECT_EQ(locked, 0u);
  EXPECT_GT(ticks, 100u);
  EXPECT_GT(arrived, 0u);
  EXPECT_GT(promoted, 0u);
  EXPECT_GT(live.watched.largest, 0.0);
}

TEST(LockCount, SeesALock) {
  std::mutex mutex;
  const test::LockCount locks;
  mutex.lock();
  mutex.unlock();
  EXPECT_EQ(locks.count(), 1u);
}

}  // namespace
}  // namespace tandem
