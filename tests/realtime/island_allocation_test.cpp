// Island::advance and all functions allowed between advances allocate nothing.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"
#include "realtime/allocation_count.h"
#include "support/solids.h"

namespace tandem {
namespace {

TEST(IslandAllocation, NoneInTheTick) {
  constexpr double kPeriod = 1e-3;  // haptic period [s]
  IslandSettings settings;
  settings.obstacle_contact = {4000.0, 1.0};
  Island island(settings);
  IslandBody device;
  device.motion = Motion::kPrescribed;
  device.feels_obstacles = true;
  const BodyIndex hip = island.addBody(device);
  IslandBody box;
  box.shape = Box{Vec3::Constant(0.02)};
  box.mass = 0.25;
  box.inertia_B = Vec3(6e-5, 7e-5, 8e-5);
  const BodyIndex cube = island.addBody(box);
  const BodyIndex slots[] = {island.addSlot(), island.addSlot()};
  island.addContact(hip, cube, {4000.0, 1.0});
  const CouplerIndex tie = island.addCoupler(cube, {{2000.0, 10.0}, {0.5, 2e-3}});
  island.prepare();
  const std::vector<Obstacle> obstacles(100, {Box{Vec3::Constant(0.02)}, Vec3(0.0, 0.05, 0.0)});

  const test::AllocationCount count;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t = kPeriod * tick;
    RigidState state;
    state.p_W = Vec3(-0.03 + 0.02 * std::sin(20.0 * t), 0.022 * std::cos(7.0 * t), 0.004);
    island.setState(hip, state);
    island.setTarget(tie, RigidState{});
    if (tick % 10 == 0) island.setObstacles(obstacles);
    for (int i = 0; i < 2; ++i) {
      box.start.p_W = Vec3(-0.05, 0.03 * i, 0.0);
      if (tick % 100 == 10 * i) island.fill(slots[i], box);
      if (tick % 100 == 50 + 10 * i) island.clear(slots[i]);
    }
    island.setExternalWrench(cube, Vec3(0.0, 0.1, 0.0), Vec3::Zero());
    island.advance(tick % 3 ? kPeriod : 0.4 * kPeriod);
  }
  EXPECT_EQ(count.count(), 0u);
  EXPECT_GT(island.counters().integrated_steps, 1000u);
  EXPECT_GT(island.counters().events, 10u);
}

// The ball moves over a mesh's triangles and a groove, while a hull and a cylinder come and go.
TEST(IslandAllocation, NoneWithHullsAndMeshes) {
  constexpr double kPeriod = 1e-3;  // haptic period [s]
  IslandSettings settings;
  settings.obstacle_contact = {2000.0, 2.0};
  Island island(settings);
  IslandBody device;
  device.motion = Motion::kPrescribed;
  device.feels_obstacles = true;
  const BodyIndex hip = island.addBody(device);
  IslandBody ball;
  ball.mass = 0.05;
  ball.feels_obstacles = true;
  const BodyIndex proxy = island.addBody(ball);
  const CouplerIndex tie = island.addCoupler(proxy, {{800.0, 4.0}, {}});
  IslandBody solid;
  solid.shape = test::makeHull(test::makeOctahedron(Vec3::Constant(0.02)));
  solid.mass = 0.25;
  solid.inertia_B = Vec3(6e-5, 7e-5, 8e-5);
  const BodyIndex object = island.addBody(solid);
  const BodyIndex slot = island.addSlot();
  island.addContact(hip, object, {2000.0, 2.0});
  island.addContact(proxy, object, {2000.0, 2.0});
  island.prepare();
  const std::vector<Obstacle> obstacles{
      {test::makeMesh(test::makeFloor(40, 0.005)), Vec3(0.0, -0.01, 0.0), Quat::Identity()},
      {test::makeMesh(test::cutIntoTriangles(test::makePrism(0.02, 0.03, 12))),
       Vec3(0.05, 0.0, 0.0), Quat::Identity()},
      {test::makeHull(test::makeBoxSolid(Vec3::Constant(0.02))), Vec3(-0.06, 0.0, 0.0),
       Quat::Identity()},
      {Cylinder{0.02, 0.02}, Vec3(0.0, 0.0, 0.06), Quat::Identity()}};

  const test::AllocationCount count;
  for (int tick = 0; tick < 3000; ++tick) {
    const double t = kPeriod * tick;
    RigidState state;
    state.p_W =
        Vec3(0.05 * std::sin(20.0 * t), 0.006 * std::cos(7.0 * t), 0.03 * std::sin(5.0 * t));
    island.setState(hip, state);
    state.p_W.z() += 0.02;
    island.setTarget(tie, state);
    if (tick % 10 == 0) island.setObstacles(obstacles);
    solid.start.p_W = Vec3(-0.05, 0.03, 0.0);
    if (tick % 100 == 10) island.fill(slot, solid);
    if (tick % 100 == 60) island.clear(slot);
    island.advance(tick % 3 ? kPeriod : 0.4 * kPeriod);
  }
  EXPECT_EQ(count.count(), 0u);
  EXPECT_GT(island.counters().integrated_steps, 1000u);
  EXPECT_GT(island.counters().events, 100u);
}

}  // namespace
}  // namespace tandem
