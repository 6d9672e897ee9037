// Ticks of sites whose hands hold, let go and break grips allocate nothing.

#include <gtest/gtest.h>

#include "grip/tool_rig.h"
#include "grip/two_grip_hosts.h"
#include "realtime/allocation_count.h"

namespace tandem::test {
namespace {

TEST(GripAllocation, TicksAndGrabsAllocateNothing) {
  constexpr int kWarmUp = 300, kTicks = 4000;
  const auto tug = [](double t) { return Vec3(0.05 * std::sin(5.0 * t), 0, 0.05); };
  TwoGripHosts hosts(tug, tug);
  for (auto& host : hosts.hosts) {
    host->settings.tick_source = TickSource::kCaller;
    host->settings.grip.max_force = 12.0;  // some break
  }
  Impairments network;
  network.delay = 0.02;
  network.loss = 0.1;
  hosts.start(network, 1.0, Vec3::Constant(0.02));
  std::size_t in_ticks = 0, in_grabs = 0;
  for (int tick = 0; tick < kWarmUp + kTicks; ++tick) {
    for (int i = 0; i < 2; ++i) {
      const AllocationCount count(tick >= kWarmUp);
      hosts.site(i).tick(tick * kTick);
      if (tick >= kWarmUp) in_ticks += count.count();
    }
    const AllocationCount count(false);
    if (tick % 500 == 100) hosts.site(0).grab(0);
    if (tick % 700 == 300) hosts.site(1).grab(0, Vec3(0.01, 0, 0));
    if (tick % 500 == 400) hosts.site(0).release();
    if (tick >= kWarmUp) in_grabs += count.count();
    if (tick % 4 == 3)
      for (auto& host : hosts.hosts) host->rig.step(4.0 * kTick);
    ASSERT_EQ(in_ticks, 0u) << "tick " << tick;
  }
  EXPECT_EQ(in_grabs, 0u);
  EXPECT_GT(hosts.site(0).latest(0).grip->epoch, 3u);
}

TEST(GripAllocation, TicksWithAToolAllocateNothing) {
  constexpr int kWarmUp = 300, kTicks = 2000;
  ToolHost host([](double t) {
    return WristDevice::Pose{Vec3(0.02 * std::sin(5.0 * t), 0, 0.06 - 0.01 * std::sin(3.0 * t)),
                             turn(0.3 * std::sin(4.0 * t), Vec3::UnitZ())};
  });
  host.settings.tick_source = TickSource::kCaller;
  host.rig.addBody(host.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0, Vec3(0, 0, -1));
  btRigidBody& stick = host.rig.addBody(
      host.rig.makeShape<btBoxShape>(toBullet(Vec3(0.01, 0.01, 0.055))), 0.05, Vec3(0, 0, 0.06));
  host.attach();
  host.site->shareTool(stick, PeerId{1});
  for (int tick = 0; tick < kWarmUp + kTicks; ++tick) {
    const AllocationCount count(tick >= kWarmUp);
    host.site->tick(tick * kTick);
    if (tick >= kWarmUp) {
      ASSERT_EQ(count.count(), 0u) << "tick " << tick;
    }
    if (tick % 4 == 3) host.rig.step(4.0 * kTick);
  }
  EXPECT_GT(host.site->torque().norm() + host.site->force().norm(), 1e-3);
}

}  // namespace
}  // namespace tandem::test
