// Private header of coordination: how couplers and stand-ins share the gains of N sites.
#include "coordination/src/schemes/coordination_shares.h"

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

TEST(CoordinationShares, OfASumAreWhole) {
  const CoordinationShares shares = computeShares(CoordinationMode::kSum, 8);
  EXPECT_EQ(shares.object, 1.0);
  EXPECT_EQ(shares.stand_in, 1.0);
}

// All couplers of one copy pull as hard as K_t (1 - 1/N) does, and all stand-ins weigh one hand.
TEST(CoordinationShares, OfAnAverageAddUp) {
  for (const int sites : {2, 3, 8, 16}) {
    const CoordinationShares shares = computeShares(CoordinationMode::kAverage, sites);
    EXPECT_NEAR((sites - 1) * shares.object, 1.0 - 1.0 / sites, 1e-15);
    EXPECT_NEAR((sites - 1) * shares.stand_in, 1.0, 1e-15);
  }
  EXPECT_EQ(computeShares(CoordinationMode::kAverage, 1).stand_in, 1.0);
}

TEST(CoordinationShares, ScaleAStandInAsAWhole) {
  const StandInSettings half = makeStandIn({0.1, 0.4, 0.01}, {200.0, 30.0}, 0.5);
  EXPECT_EQ(half.proxy.mass, 0.05);
  EXPECT_EQ(half.proxy.damping, 0.2);
  EXPECT_EQ(half.proxy.radius, 0.01);
  EXPECT_EQ(half.coordination.stiffness, 100.0);
  EXPECT_EQ(half.coordination.damping, 15.0);
  EXPECT_EQ(half.share, 0.5);
}

/// A sphere with a share that is 2 mm deep in another one.
struct Overlaps {
  explicit Overlaps(double share, const IslandSettings& settings = {}) : island(settings) {
    IslandBody part, fixed;
    part.mass = 0.1;
    part.contact_share = share;
    fixed.motion = Motion::kHeld;
    fixed.start.p_W = Vec3(0.018, 0, 0);
    sphere = island.addBody(part);
    island.addContact(sphere, island.addBody(fixed), kGains);
    island.setTouchMemory(false);  // it is deep from the start
    island.prepare();
  }
  static constexpr CouplerGains kGains{1000.0, 1.0};
  Island island;
  BodyIndex sphere = 0;
};

TEST(ContactShare, OfABodyScalesItsContacts) {
  EXPECT_NEAR(Overlaps(1.0).island.computeContactForce(0).x(), -2.0, 1e-12);
  EXPECT_NEAR(Overlaps(0.25).island.computeContactForce(0).x(), -0.5, 1e-12);
}

TEST(ContactShare, OfABodyAndALoweredShareMultiply) {
  Overlaps part(0.25);
  part.island.setContactShare(part.sphere, 0.5);
  EXPECT_EQ(part.island.contactShare(part.sphere), 0.125);
  EXPECT_NEAR(part.island.computeContactForce(0).x(), -0.25, 1e-12);
}

// A guide moves bodies by maps of the full gains, or by a series of the lowered ones.
TEST(ContactShare, ActsInAGuideAsWithoutOne) {
  IslandSettings guided;
  guided.guide = Vec3(1, 0, 0);
  Overlaps free(0.25), slot(0.25, guided);
  for (const double lowered : {1.0, 0.5}) {
    free.island.setContactShare(free.sphere, lowered);
    slot.island.setContactShare(slot.sphere, lowered);
    for (int tick = 0; tick < 4; ++tick) {
      free.island.advance(1e-3);
      slot.island.advance(1e-3);
    }
    EXPECT_LT(free.island.state(free.sphere).v_W.x(), -0.01);
    EXPECT_NEAR(slot.island.state(slot.sphere).v_W.x(), free.island.state(free.sphere).v_W.x(),
                1e-9);
  }
}

}  // namespace
}  // namespace tandem
