// Sequential impulses, which take over where the solver of rigid contact does not settle.
#include "coordination/src/island/impulse_sweeps.h"

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kMass = 0.5;  // [kg]

/// A body above a floor, one contact, and its velocity after what was held.
struct RigidSweeps : ::testing::Test {
  RigidSweeps() {
    ModelBody body;
    body.settings.mass = kMass;
    body.inverse_mass = 1.0 / kMass;
    body.settings.inertia_B = Vec3::Constant(1e-4);
    body.inverse_inertia_B = Vec3::Constant(1e4);
    body.bounding_radius = 0.05;
    mover = RigidMover(body, RigidState{});
    row.setUp(mover, standing, PlainVec(0.0, 0.0, -0.02), PlainVec(), PlainVec(0.0, 0.0, 1.0),
              PlainVec());
    row.friction = 0.5;
  }
  void sweep() {
    RigidRow* const rows[] = {&row};
    RigidMover* const movers[] = {&mover};
    (void)sweepImpulses({rows, 1, movers, 1, nullptr, 0});
  }

  RigidMover mover, standing;
  RigidRow row;
};

// The held force was twice as much as the last one, and the body flies up by it. Sweeps took back
// the last one only: half of the throw stayed.
TEST_F(RigidSweeps, TakeBackAllThatWasHeldInVain) {
  row.held = {2.0, 0.0, 0.0};     // [N s]
  row.impulse = {1.0, 0.0, 0.0};  // [N s]
  mover.v = PlainVec(0.0, 0.0, 2.0 / kMass);
  sweep();
  EXPECT_EQ(row.impulse.n, 0.0);
  EXPECT_NEAR(mover.v.z, 0.0, 1e-12);
}

// Nothing was held, and the last force was too much. A contact does not pull.
TEST_F(RigidSweeps, PullNobodyByAnImpulseThatNobodyGot) {
  row.impulse = {1.0, 0.0, 0.0};
  mover.v = PlainVec(0.0, 0.0, 0.1);
  sweep();
  EXPECT_EQ(row.impulse.n, 0.0);
  EXPECT_NEAR(mover.v.z, 0.1, 1e-12);
}

// The impulse told is the one that the body got.
TEST_F(RigidSweeps, TellTheImpulseThatStopsABody) {
  row.held = {0.3, 0.0, 0.0};
  row.impulse = {1.0, 0.0, 0.0};
  mover.v = PlainVec(0.0, 0.0, -1.0);
  sweep();
  EXPECT_NEAR(mover.v.z, 0.0, 1e-12);
  EXPECT_NEAR(row.impulse.n, 0.3 + 1.0 * kMass, 1e-12);
}

}  // namespace
}  // namespace tandem
