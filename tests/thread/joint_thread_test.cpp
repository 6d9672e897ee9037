// A body in a joint, held by a haptic thread while its host steps in real time.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/haptic_loop.h"
#include "tandem/plugin/link_queue.h"

#include "physics/joint_host.h"
#include "thread/live_rig.h"

namespace tandem {
namespace {

using test::JointHost;

/// Steps a host in real time, and calls `look` after each step.
template <typename Look>
void hostLive(JointHost& host, double seconds, double rate, Look look) {
  auto next = std::chrono::steady_clock::now();
  for (int step = 0; step < static_cast<int>(seconds * rate); ++step) {
    next += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(1.0 / rate));
    std::this_thread::sleep_until(next);
    host.rig.step(1.0 / rate);
    look();
  }
}

class LiveJoints : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(HostRates, LiveJoints, ::testing::Values(60.0, 240.0));

// The pendulum of virtual time, live: it keeps its energy however late the threads are.
TEST_P(LiveJoints, AHapticThreadKeepsAPendulumsEnergy) {
  const Vec3 pin_B(-0.5 * JointHost::kLength, 0.0, 0.0);
  JointHost host;
  btRigidBody& link = host.addLink(-pin_B);
  host.join<btHingeConstraint>(link, toBullet(pin_B), btVector3(0, 1, 0));
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  host.share(link, settings);
  LinkQueue queue, other;
  host.site->connect(PeerId{2}, queue, Vec3(0, 15, 5));
  const double before = host.energy();
  double worst = 0.0, off = 0.0, fastest = 0.0;
  {
    const test::Wire wire(queue, other);
    const HapticLoop loop(*host.site, {.priority = 0, .locks_memory = false, .begin = {}});
    hostLive(host, 3.0, GetParam(), [&] {
      worst = std::max(worst, std::abs(host.energy() - before));
      off = std::max(off, JointHost::gap(link, pin_B, Vec3::Zero()));
      fastest = std::max(fastest, static_cast<double>(link.getAngularVelocity().length()));
    });
  }
  // The copy carries half of the mass.
  EXPECT_LT(worst, 1e-4 * 0.5 * JointHost::kUnit);
  // A late host may get a cubic over a step of 1/60 s: (w h)^4 / 384 of 0.1 m for place and turn.
  EXPECT_LT(off, 2e-6);
  EXPECT_GT(fastest, 1.0);
  EXPECT_EQ(host.site->status(), kTickOk);
}

}  // namespace
}  // namespace tandem
