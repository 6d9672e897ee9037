// Private header of the plugin: forces of the host on bodies of the island.
#include "plugin/src/site/host_forces.h"

#include <cmath>

#include <gtest/gtest.h>

#include "site/parts_rig.h"
#include "support/random.h"

namespace tandem {
namespace {

using test::kPeriod;
using test::PartsRig;

/// A host that pushes body 0, and the ticks of its site.
struct PushingHost {
  explicit PushingHost(bool ticks_in_step) : is_behind(ticks_in_step) {}

  /// One step of the host. Ticks run inside of it, or have run before it begins.
  void step(double dt, const Vec3& f_W, const Vec3& t_W, const Vec3& hit_W = Vec3::Zero()) {
    if (!is_behind) runTicksUntil(rig.clock.time() + dt);
    HandOver& told = rig.body(0).step;
    told.is_told = true;
    told.change = {};
    told.change.f_W = f_W;
    told.change.t_W = t_W;
    told.change.impulse_W = dt * f_W + hit_W;
    told.change.angular_impulse_W = dt * t_W;
    rig.forces.pass(dt, is_behind);
    given_W += dt * f_W + hit_W;
    turned_W += dt * t_W;
    if (is_behind) runTicksUntil(rig.clock.time() + dt);
    rig.clock.endStep(dt);
  }

  /// Whole ticks, each in random parts.
  void runTicksUntil(double time) {
    while (ticks * kPeriod < time - kClockTolerance) {
      const double end = ++ticks * kPeriod;
      while (rig.timeline.time() < end) {
        const double part = random.uniform(0.0, 1.5 * kPeriod);
        const double next = std::min({end, rig.timeline.time() + part, rig.forces.nextEnd()});
        rig.timeline.moveTo(end - next < 1e-6 ? end : next);
        rig.forces.endIfDue();
      }
    }
  }

  [[nodiscard]] Vec3 momentum() const {
    return PartsRig::kMass * rig.island.state(rig.index(0)).v_W;
  }
  [[nodiscard]] Vec3 spin() const {
    return PartsRig::kInertia * rig.island.state(rig.index(0)).w_W;
  }

  PartsRig rig{1};
  static constexpr std::uint64_t kSeed = 45;
  test::Random random{kSeed};
  bool is_behind;
  int ticks = 0;
  Vec3 given_W = Vec3::Zero(), turned_W = Vec3::Zero();
};

TEST(HostForces, ASteadyForceIsSteadyOverAnySplitOfTicks) {
  SCOPED_TRACE(PushingHost::kSeed);
  const Vec3 f_W(3, -2, 1), t_W(1e-4, 0, -2e-4);
  PushingHost host(true);
  for (int i = 0; i < 300; ++i) {
    host.step(host.random.uniform(2e-3, 0.04), f_W, t_W);
    const double time = host.rig.timeline.time();
    ASSERT_LT((host.momentum() - time * f_W).norm(), 1e-12 * (1.0 + time)) << i;
    ASSERT_LT((host.spin() - time * t_W).norm(), 1e-12 * (1.0 + time)) << i;
  }
}

TEST(HostForces, ASteadyForceActsAStepLateIfTicksHaveRun) {
  const Vec3 f_W(3, -2, 1);
  constexpr double kStep = 16 * kPeriod;
  PushingHost host(false);
  for (int i = 0; i < 100; ++i) {
    host.step(kStep, f_W, Vec3::Zero());
    ASSERT_LT((host.momentum() - i * kStep * f_W).norm(), 1e-12) << i;
  }
}

// The momentum of the body and the momentum that it is owed add up to what the host gave.
TEST(HostForces, LoseAndMakeNoMomentum) {
  SCOPED_TRACE(PushingHost::kSeed);
  for (const bool is_behind : {true, false}) {
    SCOPED_TRACE(is_behind);
    PushingHost host(is_behind);
    for (int i = 0; i < 300; ++i) {
      const bool pushes = host.random.below(3) > 0, hits = host.random.below(10) == 0;
      host.step(host.random.uniform(2e-3, 0.04), pushes ? host.random.inCube(5.0) : Vec3::Zero(),
                pushes ? host.random.inCube(1e-3) : Vec3::Zero(),
                hits ? host.random.inCube(0.1) : Vec3::Zero());
      host.rig.forces.settle();
      const Momentum& owed = host.rig.body(0).load.owed;
      ASSERT_LT((host.momentum() + owed.linear_W - host.given_W).norm(), 1e-11) << i;
      ASSERT_LT((host.spin() + owed.angular_W - host.turned_W).norm(), 1e-11) << i;
    }
    // After the pushes all of it arrives.
    for (int i = 0; i < 4; ++i) host.step(16 * kPeriod, Vec3::Zero(), Vec3::Zero());
    EXPECT_LT((host.momentum() - host.given_W).norm(), 1e-11);
    EXPECT_LT((host.spin() - host.turned_W).norm(), 1e-11);
    EXPECT_TRUE(host.rig.body(0).load.isSettled());
  }
}

TEST(HostForces, EndWithoutNewsAndTakeBackTheExcess) {
  const Vec3 f_W(3, 0, 0), weight_W(0, 0, -2);
  constexpr double kStep = 16 * kPeriod;
  PushingHost host(true);
  host.rig.body(0).step.f_gravity_W = weight_W;
  host.step(kStep, f_W, Vec3::Zero());
  EXPECT_NEAR(host.rig.forces.nextEnd(), 2 * kStep, 1e-15);
  EXPECT_LT((host.rig.island.externalForce(host.rig.index(0)) - f_W - weight_W).norm(), 1e-12);

  // The host is silent: the force acts for one more step, the weight goes on.
  host.runTicksUntil(10 * kStep);
  EXPECT_EQ(host.rig.forces.nextEnd(), kNever);
  EXPECT_EQ(host.rig.island.externalForce(host.rig.index(0)), weight_W);
  EXPECT_LT((host.momentum() - 2 * kStep * f_W - 10 * kStep * weight_W).norm(), 1e-12);

  // The host comes back without a force, at the island's time.
  host.rig.clock.endStep(9 * kStep);
  for (int i = 0; i < 2; ++i) host.step(kStep, Vec3::Zero(), Vec3::Zero());
  EXPECT_LT((host.momentum() - kStep * f_W - 12 * kStep * weight_W).norm(), 1e-12);
}

TEST(HostForces, OweTheHostsBodyWhatTheIslandGotAheadOfIt) {
  PushingHost host(true);
  host.runTicksUntil(10 * kPeriod);
  host.rig.forces.skip();
  SiteBody& body = host.rig.body(0);
  const Momentum hit{Vec3(0.1, 0, 0), Vec3(0, 1e-4, 0)};
  host.rig.forces.give(body, hit);
  EXPECT_LT((host.momentum() - hit.linear_W).norm(), 1e-15);
  EXPECT_EQ(host.rig.forces.computeOwed(body).linear_W, hit.linear_W);
  EXPECT_EQ(host.rig.forces.computeOwed(body).angular_W, hit.angular_W);
  host.rig.clock.endStep(9 * kPeriod);
  host.rig.forces.forgetLate(body);
  EXPECT_EQ(host.rig.forces.computeOwed(body).linear_W, hit.linear_W);
  host.rig.clock.endStep(2 * kPeriod);
  host.rig.forces.forgetLate(body);
  EXPECT_TRUE(host.rig.forces.computeOwed(body).isZero());
  EXPECT_TRUE(body.load.late.empty());
}

TEST(HostForces, DropOnlyRounding) {
  EXPECT_EQ(dropRounding(Vec3(9e-16, 0, 0)), Vec3::Zero());
  EXPECT_EQ(dropRounding(Vec3(0, 1.1e-15, 0)), Vec3(0, 1.1e-15, 0));
}

}  // namespace
}  // namespace tandem
