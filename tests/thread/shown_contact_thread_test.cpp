// With a haptic thread, the host's thread alone shows contact and calls Bullet's callbacks.

#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "thread/live_rig.h"

namespace tandem {
namespace {

using test::LiveSite;

std::thread::id host_thread;
std::atomic<int> here{0}, elsewhere{0};

void noteThread() { ++(std::this_thread::get_id() == host_thread ? here : elsewhere); }

double sumImpulses(LiveSite& live) {
  double sum = 0.0;
  for (int m = 0; m < live.rig.dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *live.rig.dispatcher.getManifoldByIndexInternal(m);
    const bool is_floor = manifold.getBody0() == live.rig.bodies.front().get() ||
                          manifold.getBody1() == live.rig.bodies.front().get();
    if (!is_floor || (manifold.getBody0() != live.cube && manifold.getBody1() != live.cube))
      continue;
    for (int i = 0; i < manifold.getNumContacts(); ++i)
      sum += static_cast<double>(manifold.getContactPoint(i).m_appliedImpulse);
  }
  return sum;
}

TEST(ShownContactLive, TheFloorCarriesTheCubeAndOnlyTheHostIsCalled) {
  host_thread = std::this_thread::get_id();
  here = elsewhere = 0;
  gContactStartedCallback = [](btPersistentManifold* const&) { noteThread(); };
  gContactEndedCallback = [](btPersistentManifold* const&) { noteThread(); };
  gContactProcessedCallback = [](btManifoldPoint&, void*, void*) {
    noteThread();
    return true;
  };
  {
    LiveSite live(1, Vec3(0.0, 2.0, 0.0), 3);
    HapticLoop loop(*live.site, {.priority = 0, .locks_memory = false, .begin = {}});
    double sum = 0.0;
    constexpr int kSteps = 90;
    for (int step = 0; step < kSteps; ++step) {
      live.host(1.0001 * LiveSite::kHostPeriod);
      sum += sumImpulses(live);
    }
    loop.stop();
    const double weight = 9.81 / static_cast<double>(live.cube->getInvMass());
    // The first step shows nothing yet, and a host that is late may get a step's impulse twice.
    EXPECT_NEAR(sum, weight * kSteps * LiveSite::kHostPeriod,
                0.2 * weight * kSteps * LiveSite::kHostPeriod);
  }
  gContactStartedCallback = nullptr;
  gContactEndedCallback = nullptr;
  gContactProcessedCallback = nullptr;
  EXPECT_GT(here, 0);
  EXPECT_EQ(elsewhere, 0);
}

}  // namespace
}  // namespace tandem
