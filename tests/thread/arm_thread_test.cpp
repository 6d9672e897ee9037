// A haptic thread beside a host that steps a multi-body, changes its motors, and takes it out.

#include <chrono>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "tandem/plugin/haptic_loop.h"

#include "physics/arm_host.h"

namespace tandem {
namespace {

using test::ArmHost;

TEST(ArmThread, AHapticThreadHoldsAnArmWhileTheHostSteps) {
  constexpr HapticLoopSettings kModest{.priority = 0, .locks_memory = false, .begin = {}};
  constexpr double kRate = 120.0;
  ArmHost host;
  host.build(test::makeChain(3));
  btMultiBodyJointMotor& motor = host.addMotor(0, 0.0, 0.1);
  host.addLimit(1, -0.5, 0.5);
  host.device.sample.hip.p_W = Vec3(0.0, 0.06, 0.0);
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  settings.host_step = 1.0 / kRate;
  settings.host_stall = 0.1;
  host.start(settings);
  HapticLoop loop(*host.site, kModest);
  auto next = std::chrono::steady_clock::now();
  for (int i = 0; i < static_cast<int>(1.5 * kRate); ++i) {
    if (i == 60) motor.setVelocityTarget(btScalar(0.5));
    if (i % 10 == 0) host.arm().addJointTorque(2, btScalar(0.01));
    if (i == 100) {
      for (const auto& collider : host.host.colliders)
        host.host.world->removeCollisionObject(collider.get());
      host.host.multi()->removeMultiBody(&host.arm());
    }
    if (i == 120) {
      host.host.multi()->addMultiBody(&host.arm());
      for (const auto& collider : host.host.colliders)
        host.host.world->addCollisionObject(collider.get(), 1, -1);
    }
    host.step(1.0 / kRate);
    next += std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(1.0 / kRate));
    std::this_thread::sleep_until(next);
  }
  loop.stop();
  EXPECT_EQ(host.site->counters().promoted, 6U);
  EXPECT_EQ(host.site->counters().demoted, 3U);
  for (int i = 0; i < 3; ++i) EXPECT_LT(std::abs(host.u(i)), 60.0);
  EXPECT_LT(std::abs(host.q(1)), 0.51);
}

}  // namespace
}  // namespace tandem
