// Private header of the plugin: the smooth way of an object's target back to the received state.
#include "plugin/src/site/detour.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double kTick = 1e-3;

RigidState stateOf(const Vec3& p_W, const Quat& q_WB) {
  RigidState state;
  state.p_W = p_W;
  state.q_WB = q_WB;
  return state;
}

TEST(Detour, NoneChangesNothing) {
  const RigidState theirs = stateOf(Vec3(1, 2, 3), Quat(0.6, 0, 0.8, 0));
  const Detour detour;
  EXPECT_TRUE(detour.isOver());
  EXPECT_EQ(detour.apply(theirs).p_W, theirs.p_W);
  EXPECT_EQ(detour.apply(theirs).q_WB.coeffs(), theirs.q_WB.coeffs());
}

// The detour begins at our state and ends at theirs, in bounded time and at the stated speed.
TEST(Detour, LeadsFromOursToTheirs) {
  constexpr std::uint64_t kSeed = 43;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int trial = 0; trial < 100; ++trial) {
    const double size = random.logUniform(1e-4, 10.0);
    const RigidState ours = stateOf(random.inCube(size), random.rotation());
    RigidState theirs = stateOf(random.inCube(size), random.rotation());
    theirs.v_W = random.inCube(1.0);
    const double top_speed = std::max(0.25, (ours.p_W - theirs.p_W).norm() / 2.0);
    Detour detour;
    detour.start(ours, theirs);
    RigidState at = detour.apply(theirs);
    EXPECT_LT((at.p_W - ours.p_W).norm(), 1e-12 * size);
    EXPECT_LT(at.q_WB.angularDistance(ours.q_WB), 1e-7);
    int ticks = 0;
    for (; !detour.isOver(); ++ticks) {
      ASSERT_LT(ticks, 4500);
      const RigidState before = at;
      ASSERT_LE((before.v_W - theirs.v_W).norm(), top_speed * (1.0 + 1e-12));
      ASSERT_LE((before.w_W - theirs.w_W).norm(), 2.5 + 1e-12);
      detour.advance(kTick);
      at = detour.apply(theirs);
      // The motion agrees with the reported velocity.
      ASSERT_LT((at.p_W - before.p_W - kTick * (before.v_W - theirs.v_W)).norm(), 2e-6);
      const Quat turned = before.q_WB * at.q_WB.conjugate();
      const Vec3 turn = -2.0 * (turned.w() < 0.0 ? -1.0 : 1.0) * turned.vec();
      ASSERT_LT((turn - kTick * before.w_W).norm(), 2e-6);
    }
    EXPECT_EQ(at.p_W, theirs.p_W);
    EXPECT_EQ(at.q_WB.coeffs(), theirs.q_WB.coeffs());
  }
}

}  // namespace
}  // namespace tandem
