// Private header of the plugin: the last limit on the force before the device.
#include "plugin/src/site/force_guard.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

Vec3 limit(ForceGuard& guard, const Vec3& wanted_W, bool fault) {
  const Vec3 force_W = guard.follow(guard.clamp(wanted_W), fault);
  guard.note(force_W);
  return force_W;
}

TEST(ForceGuard, LetsAllowedForcesThroughToTheBit) {
  ForceGuard guard(9.0, 10.0, 2.0);
  for (const double f : {0.1, 3.0, -5.0, 0.7}) {
    const Vec3 wanted_W(f, 0.3 * f, 0);
    EXPECT_EQ(limit(guard, wanted_W, false), wanted_W);
  }
  EXPECT_EQ(guard.clampedCount() + guard.slewedCount(), 0u);
}

TEST(ForceGuard, ClampsWithTheDirectionKept) {
  ForceGuard guard(5.0, kInf, 2.0);
  const Vec3 wanted_W(30.0, -40.0, 0.0);
  EXPECT_LT((limit(guard, wanted_W, false) - Vec3(3.0, -4.0, 0.0)).norm(), 1e-14);
  EXPECT_EQ(guard.clampedCount(), 1u);
}

TEST(ForceGuard, RisesNoFasterThanAllowed) {
  ForceGuard guard(kInf, 0.5, 2.0);
  EXPECT_NEAR(limit(guard, Vec3(1.2, 0, 0), false).x(), 0.5, 1e-15);
  EXPECT_NEAR(limit(guard, Vec3(1.2, 0, 0), false).x(), 1.0, 1e-15);
  EXPECT_EQ(limit(guard, Vec3(1.2, 0, 0), false).x(), 1.2);
  EXPECT_EQ(guard.slewedCount(), 2u);
}

// A slow fall would push on a hand that has left the wall: 5.7 kJ in 20 s.
TEST(ForceGuard, FallsAtOnce) {
  ForceGuard guard(kInf, 0.5, 2.0);
  const auto rise = [&] {
    for (int i = 0; i < 10; ++i) (void)limit(guard, Vec3(5, 0, 0), false);
  };
  for (const Vec3& wanted_W : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(4.9, 0.1, 0)}) {
    rise();
    EXPECT_EQ(limit(guard, wanted_W, false), wanted_W);
  }
  // The other way is a rise from zero, and another direction one from what both share.
  rise();
  EXPECT_LT((limit(guard, Vec3(-5, 0, 0), false) - Vec3(-0.5, 0, 0)).norm(), 1e-15);
  for (int i = 0; i < 20; ++i) (void)limit(guard, Vec3(5, 0, 0), false);
  EXPECT_LT((limit(guard, Vec3(2, 4, 0), false) - Vec3(2, 0.5, 0)).norm(), 1e-15);
}

TEST(ForceGuard, RisesFromWhatWasRenderedInTheEnd) {
  ForceGuard guard(kInf, 0.5, 2.0);
  for (int i = 0; i < 10; ++i) (void)limit(guard, Vec3(5, 0, 0), false);
  guard.note(Vec3(1, 0, 0));
  EXPECT_LT((limit(guard, Vec3(5, 0, 0), false) - Vec3(1.5, 0, 0)).norm(), 1e-15);
}

TEST(ForceGuard, FadesAfterAFaultAndWithoutANumber) {
  for (const bool is_fault : {true, false}) {
    ForceGuard guard(kInf, kInf, 2.0);
    (void)limit(guard, Vec3(0, 5.0, 0), false);
    const Vec3 wanted_W(0, is_fault ? 5.0 : std::nan(""), 0);
    for (const double left : {3.0, 1.0, 0.0, 0.0})
      EXPECT_NEAR(limit(guard, wanted_W, is_fault).y(), left, 1e-15);
  }
}

TEST(ForceGuard, FadesNoFasterThanItMayChange) {
  ForceGuard guard(kInf, 0.5, 2.0);
  (void)limit(guard, Vec3(0.5, 0, 0), false);
  (void)limit(guard, Vec3(1.0, 0, 0), false);
  EXPECT_NEAR(limit(guard, Vec3::Zero(), true).x(), 0.5, 1e-15);
}

TEST(ForceGuard, HoldsItsBoundsWhateverIsWanted) {
  constexpr std::uint64_t kSeed = 42;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  ForceGuard guard(9.0, 1.5, 0.5);
  Vec3 last_W = Vec3::Zero();
  for (int i = 0; i < 100000; ++i) {
    Vec3 wanted_W;
    for (int k = 0; k < 3; ++k) {
      const double odd[] = {random.uniform(-20, 20), random.uniform(-1, 1), 1e308, -kInf,
                            std::nan("")};
      const int which = random.below(20);
      wanted_W[k] = odd[which < 5 ? which : which % 2];
    }
    const Vec3 force_W = limit(guard, wanted_W, random.below(10) == 0);
    ASSERT_TRUE(force_W.allFinite());
    ASSERT_LE(force_W.norm(), 9.0 + 1e-12);
    ASSERT_LE(force_W.norm() - last_W.norm(), 1.5 + 1e-12);
    last_W = force_W;
  }
}

}  // namespace
}  // namespace tandem
