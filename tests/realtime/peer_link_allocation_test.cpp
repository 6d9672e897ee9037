// The haptic thread's side of a peer's link neither allocates nor locks. The same holds for the
// side of the socket's thread.

#include <gtest/gtest.h>

#include "tandem/coordination/simulated_link.h"

#include "live/peer_link.h"
#include "realtime/allocation_count.h"
#include "realtime/lock_count.h"

namespace tandem {
namespace {

TEST(PeerLinkAllocation, NoneForAStateBesideAHapticThreadOrWithoutOne) {
  for (const bool has_haptic_thread : {false, true}) {
    auto ends = makeSimulatedLinks({.delay = 0.01});
    PeerLink here(*ends.first), there(*ends.second);
    here.setHapticThread(has_haptic_thread);
    there.setHapticThread(has_haptic_thread);
    StatePacket packet;
    packet.sender = PeerId{1};
    int given = 0;
    const auto tick = [&](int i) {
      const double time = 1e-3 * i, clock = 100.0 + time;
      for (PeerLink* link : {&here, &there}) {
        link->bridge().setClock(clock);
        link->exchange(2e-3);
      }
      here.send(packet, time);
      (void)here.receive(time, time + 1e-3);
      while (there.receive(time, time + 1e-3)) ++given;
    };
    for (int i = 0; i < 100; ++i) tick(i);
    const test::AllocationCount allocations;
    const test::LockCount locks;
    given = 0;
    for (int i = 100; i < 10100; ++i) tick(i);
    EXPECT_EQ(allocations.count(), 0u) << has_haptic_thread;
    EXPECT_EQ(locks.count(), 0u) << has_haptic_thread;
    EXPECT_NEAR(given, 10000, 2) << has_haptic_thread;
  }
}

}  // namespace
}  // namespace tandem
