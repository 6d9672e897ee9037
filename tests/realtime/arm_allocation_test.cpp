// Ticks beside a held multi-body, and its hand-off, take nothing from the heap.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <gtest/gtest.h>

#include <BulletDynamics/Featherstone/btMultiBodyFixedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>

#include "bullet_bridge/src/arms/host_arm.h"
#include "physics/arm_host.h"
#include "realtime/allocation_count.h"

namespace tandem {
namespace {

using test::AllocationCount;
using test::ArmHost;

/// The most force of a hand that presses a link, and allocations in ticks after some host steps.
struct Pressing {
  double most = 0.0;
  std::size_t allocations = 0;
};

Pressing press(ArmHost& host) {
  SiteSettings settings;
  settings.tick_source = TickSource::kCaller;
  settings.host_step = 1.0 / 60.0;
  settings.host_stall = 0.1;
  const auto handAt = [](double t) { return Vec3(0.5, 0.0, 0.034 - 0.01 * std::sin(6.0 * t)); };
  host.device.sample.hip.p_W = handAt(0.0);
  host.start(settings);
  int tick = 0;
  Pressing pressing;
  for (int i = 0; i < 120; ++i) {
    for (; tick < 1000 * (i + 1) / 60; ++tick) {
      host.device.sample.hip.p_W = handAt(1e-3 * tick);
      const AllocationCount count(false);
      host.site->tick(1e-3 * tick);
      if (i >= 30) pressing.allocations += count.count();
      pressing.most = std::max(pressing.most, host.device.force_W.norm());
    }
    host.step(1.0 / 60.0);
  }
  return pressing;
}

TEST(ArmAllocation, NoneInTheTick) {
  ArmHost host;
  host.build(test::makeChain(4));
  for (int i = 0; i < 4; ++i) host.addMotor(i, 0.0, 1.0);
  host.addLimit(1, -0.5, 0.5);
  const Pressing pressing = press(host);
  EXPECT_EQ(host.site->counters().promoted, 4U);
  EXPECT_GT(pressing.most, 1.0);
  EXPECT_EQ(pressing.allocations, 0U);
}

TEST(ArmAllocation, NoneInTheTickWithConstraints) {
  ArmHost host;
  host.build(test::makeChain(4));
  for (int i = 0; i < 3; ++i) host.addMotor(i, 0.0, 1.0);
  btRigidBody* const nothing = nullptr;
  const btVector3 end(btScalar(0.1), 0, 0), place(btScalar(0.8), 0, 0);
  host.add<btMultiBodyPoint2Point>(3, nothing, end, place);
  btRigidBody& cube = host.host.addCube(0.1, Vec3(0.3, 0.0, 0.05));
  const btMatrix3x3 straight = btMatrix3x3::getIdentity();
  host.add<btMultiBodyFixedConstraint>(1, &cube, btVector3(0, 0, btScalar(0.05)),
                                       btVector3(0, 0, 0), straight, straight);
  const Pressing pressing = press(host);
  EXPECT_EQ(host.site->counters().promoted, 5U);
  EXPECT_GT(pressing.most, 1.0);
  EXPECT_EQ(pressing.allocations, 0U);
}

TEST(ArmAllocation, NoneInHandOff) {
  ArmHost host;
  host.build(test::makeChain(4));
  HostArm arm(*host.host.multi(), host.arm());
  arm.remember();
  for (int i = 0; i < 20; ++i) {
    const AllocationCount count(false);
    arm.look(1e-3);
    for (const auto& link : arm.links()) {
      RigidState end = link->state();
      end.v_W += Vec3(0.0, 0.0, 1e-3);
      link->handOff(end, 1e-3, {Vec3(0.0, 0.0, 1e-3), Vec3::Zero()});
    }
    arm.handOff(1e-3);
    arm.restore();
    EXPECT_TRUE(i == 0 || count.count() == 0U);
  }
}

}  // namespace
}  // namespace tandem
