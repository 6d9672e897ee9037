// Private headers of the plugin: marks of an island's rest, and quiet steps of the host.
#include "plugin/src/site/rest.h"

#include <gtest/gtest.h>

#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "site/parts_rig.h"

namespace tandem {
namespace {

using test::kPeriod;
using test::PartsRig;

void runUntilAsleep(PartsRig& rig) {
  for (int i = 0; i < 100 && !rig.island.isAsleep(); ++i) rig.island.advance(kPeriod);
  ASSERT_TRUE(rig.island.isAsleep());
}

TEST(RestMark, HoldsUntilSomethingChanges) {
  PartsRig rig(1);
  runUntilAsleep(rig);
  RestMark mark;
  EXPECT_FALSE(mark.holds(rig.island));
  mark.set(rig.island);
  for (int i = 0; i < 5; ++i) rig.island.advance(kPeriod);
  EXPECT_TRUE(mark.holds(rig.island));
  // The same value again changes nothing.
  rig.island.setState(rig.index(0), rig.island.state(rig.index(0)));
  EXPECT_TRUE(mark.holds(rig.island));

  RigidState state = rig.island.state(rig.index(0));
  state.p_W.x() += 0.1;
  rig.island.setState(rig.index(0), state);
  EXPECT_FALSE(mark.holds(rig.island));
  // It does not hold either when the island sleeps again, elsewhere.
  runUntilAsleep(rig);
  EXPECT_FALSE(mark.holds(rig.island));
  mark.set(rig.island);
  EXPECT_TRUE(mark.holds(rig.island));
  mark.clear();
  EXPECT_FALSE(mark.holds(rig.island));
}

TEST(RestMark, NeverHoldsIfSetWhileAwake) {
  PartsRig rig(1);
  rig.setVelocity(0, Vec3(1, 0, 0));
  RestMark mark;
  mark.set(rig.island);
  EXPECT_FALSE(mark.holds(rig.island));
  rig.setVelocity(0, Vec3::Zero());
  runUntilAsleep(rig);
  EXPECT_FALSE(mark.holds(rig.island));
}

/// A world without bodies.
struct EmptyWorld {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
};

TEST(Rest, AStepIsQuietWhileTheIslandSleepsOn) {
  EmptyWorld host;
  PartsRig rig(1);
  Rest rest(host.world, 0.01, rig.log);
  const Bodies none;
  EXPECT_FALSE(rest.looksQuiet());
  runUntilAsleep(rig);
  rest.mark(rig.island, Vec3::Zero());
  rest.fallQuiet(none);
  ASSERT_TRUE(rest.looksQuiet());
  EXPECT_TRUE(rest.begin(true, rig.island));
  EXPECT_TRUE(rest.isQuiet());
  EXPECT_TRUE(rest.stays(rig.island));
  EXPECT_TRUE(rest.staysQuiet());

  // The island moves in the step.
  rig.setVelocity(0, Vec3(1, 0, 0));
  EXPECT_FALSE(rest.stays(rig.island));
  EXPECT_FALSE(rest.staysQuiet());
  EXPECT_FALSE(rest.begin(true, rig.island));
}

TEST(Rest, IsOverWhenDisturbedOrTheWorldHasNews) {
  EmptyWorld host;
  PartsRig rig(1);
  Rest rest(host.world, 0.01, rig.log);
  const Bodies none;
  runUntilAsleep(rig);
  rest.mark(rig.island, Vec3::Zero());
  rest.fallQuiet(none);
  EXPECT_FALSE(rest.begin(false, rig.island));
  EXPECT_TRUE(rest.begin(true, rig.island));
  rest.disturb();
  EXPECT_FALSE(rest.isQuiet());
  EXPECT_FALSE(rest.looksQuiet());

  // A mark of an island that is awake lets no step be quiet.
  rig.setVelocity(0, Vec3(1, 0, 0));
  rest.mark(rig.island, Vec3::Zero());
  rest.fallQuiet(none);
  EXPECT_FALSE(rest.looksQuiet());
}

}  // namespace
}  // namespace tandem
