// Private header of the plugin: island time and kept states.
#include "plugin/src/site/timeline.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/random.h"

namespace tandem {
namespace {

constexpr double kTick = 1e-3;  // haptic period [s]
constexpr double kMass = 0.5;   // [kg]

/// One free body on the x axis.
struct MovingBody {
  explicit MovingBody(double v, double spring = 0.0) {
    IslandBody settings;
    settings.mass = kMass;
    settings.inertia_B = Vec3::Constant(2e-4);
    settings.start.v_W.x() = v;
    body = island.addBody(settings);
    if (spring > 0.0) {
      const CouplerIndex coupler = island.addCoupler(body, {{spring, 0.0}, {}});
      island.prepare();
      island.setTarget(coupler, RigidState{});
    }
    island.prepare();
    timeline.setBodyCount(1);
    timeline.makeRoom(64);
  }

  /// Runs ticks up to tick `end`, stopping at announced ends as a site does.
  void runUntilTick(int end) {
    for (; tick < end; ++tick) {
      const double now = tick * kTick, next = (tick + 1) * kTick;
      timeline.startTick(now);
      timeline.keepStart();
      while (timeline.announcedEnd() < next - kSameTime) timeline.moveTo(timeline.announcedEnd());
      timeline.moveTo(next);
      timeline.endTick();
    }
  }
  double keptX(double time) {
    const std::vector<RigidState>* states = timeline.findStates(time);
    return states ? (*states)[0].p_W.x() : std::numeric_limits<double>::quiet_NaN();
  }

  Island island{IslandSettings{}};
  Timeline timeline{island, kTick, 0.0};
  BodyIndex body = 0;
  int tick = 0;
};

// An object that is shared while the site runs. Without a past of its own it flew in from the
// origin where newcomers were caught up.
TEST(Timeline, GivesABodyAddedLaterAPastOfItsOwn) {
  MovingBody moving(2.0);
  moving.timeline.announce(2.6 * kTick, 2.6 * kTick);
  moving.runUntilTick(4);
  IslandBody settings;
  settings.mass = kMass;
  settings.inertia_B = Vec3::Constant(2e-4);
  settings.start.p_W = Vec3(5.0, 0.0, 0.0);
  const BodyIndex added = moving.island.addBody(settings);
  moving.island.prepare();
  moving.timeline.setBodyCount(2);
  for (const double ticks : {2.6, 2.8, 3.0, 3.5, 4.0})
    EXPECT_EQ(moving.timeline.stateAt(added, ticks * kTick).p_W.x(), 5.0) << ticks;
  EXPECT_NEAR(moving.timeline.stateAt(moving.body, 3.5 * kTick).p_W.x(), 7e-3, 1e-9);
}

// A slot's kept states are of the body before. A newcomer caught up from them would fly to its
// place, and throw whatever stands on the way.
TEST(Timeline, GivesANewcomerAPastOfItsOwn) {
  MovingBody moving(2.0);
  moving.timeline.announce(2.6 * kTick, 2.6 * kTick);
  moving.runUntilTick(4);
  ASSERT_GT(moving.keptX(2.6 * kTick), 0.0);
  RigidState newcomer;
  newcomer.p_W = Vec3(5.0, 0.0, 0.0);
  moving.island.setState(moving.body, newcomer);
  moving.timeline.enter(moving.body, newcomer);
  EXPECT_EQ(moving.keptX(2.6 * kTick), 5.0);
  for (const double ticks : {2.6, 2.8, 3.0, 3.5, 4.0})
    EXPECT_EQ(moving.timeline.stateAt(moving.body, ticks * kTick).p_W.x(), 5.0) << ticks;
}

TEST(Timeline, KeepsAnnouncedEndsExactly) {
  constexpr std::uint64_t kSeed = 44;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  for (int trial = 0; trial < 20; ++trial) {
    const double f = random.uniform(-5.0, 5.0), v = random.uniform(-1.0, 1.0);
    const double first = random.uniform(1e-4, 0.02), step = random.uniform(2e-3, 0.03);
    MovingBody rig(v);
    rig.island.setExternalWrench(rig.body, Vec3(f, 0, 0), Vec3::Zero());
    rig.timeline.announce(first, step);
    rig.runUntilTick(100);
    int kept = 0;
    for (double end = first; end < 0.1; end += step, ++kept)
      ASSERT_NEAR(rig.keptX(end), v * end + f / kMass * end * end / 2.0, 1e-14) << end;
    ASSERT_GE(kept, 3);
    EXPECT_EQ(rig.timeline.findStates(first + 1e-6), nullptr);
    EXPECT_EQ(rig.timeline.findStates(0.1 + step), nullptr);
  }
}

TEST(Timeline, IsExactBetweenMomentsForASteadyForce) {
  constexpr double kForce = 3.0, kSpeed = -0.4;  // [N], [m/s]
  MovingBody rig(kSpeed);
  rig.island.setExternalWrench(rig.body, Vec3(kForce, 0, 0), Vec3::Zero());
  rig.timeline.announce(0.016, 0.016);
  rig.runUntilTick(50);
  const double a = kForce / kMass;
  for (const double time : {0.0163, 0.0251, 0.0319, 0.0321, 0.0485, 0.0491, 0.0499, 0.05}) {
    const RigidState state = rig.timeline.stateAt(rig.body, time);
    EXPECT_NEAR(state.p_W.x(), kSpeed * time + a * time * time / 2.0, 1e-14) << time;
    EXPECT_NEAR(state.v_W.x(), kSpeed + a * time, 1e-12) << time;
  }
}

// A pendulum's pin would open if its turn were interpolated less exactly than its place.
TEST(Timeline, IsExactBetweenMomentsForASteadyTorque) {
  constexpr double kTorque = 3e-3;  // [N m]
  MovingBody rig(0.0);
  rig.island.setExternalWrench(rig.body, Vec3::Zero(), Vec3(0, 0, kTorque));
  rig.timeline.announce(0.016, 0.016);
  rig.runUntilTick(50);
  const double a = kTorque / rig.island.body(rig.body).inertia_B.z();
  for (const double time : {0.0163, 0.0251, 0.0319, 0.0321, 0.0485, 0.0491, 0.0499, 0.05}) {
    const RigidState state = rig.timeline.stateAt(rig.body, time);
    const Quat turned(Eigen::AngleAxisd(a * time * time / 2.0, Vec3::UnitZ()));
    EXPECT_LT(state.q_WB.angularDistance(turned), 1e-9) << time;
    EXPECT_NEAR(state.w_W.z(), a * time, 1e-9) << time;
  }
}

// x = A sin(w t). Half way between two kept moments around a turning point, a cubic is off by w^4
// h^4 / 384 A.
TEST(Timeline, IsACubicBetweenMomentsOfAnOscillation) {
  constexpr double kOmega = 20.0, kStep = 0.02, kSpeed = 1.0;  // [rad/s], [s], [m/s]
  MovingBody rig(kSpeed, kMass * kOmega * kOmega);
  rig.timeline.announce(kStep, kStep);
  rig.runUntilTick(200);
  const double amplitude = kSpeed / kOmega;
  const double bound = amplitude * std::pow(kOmega * kStep, 4) / 384.0;
  double most = 0.0;
  for (int i = 200; i < 1800; ++i) {
    const double time = i * 1e-4;
    const double error =
        rig.timeline.stateAt(rig.body, time).p_W.x() - amplitude * std::sin(kOmega * time);
    most = std::max(most, std::abs(error));
  }
  EXPECT_LT(most, 1.01 * bound);
  EXPECT_GT(most, 0.8 * bound);
}

TEST(Timeline, KeepsNoEndInLostTime) {
  MovingBody rig(1.0);
  rig.timeline.announce(0.016, 0.016);
  rig.runUntilTick(20);
  rig.timeline.lose(0.1);
  EXPECT_EQ(rig.timeline.time(), 0.1);
  EXPECT_NEAR(rig.timeline.announcedEnd(), 0.112, 1e-12);
  EXPECT_EQ(rig.timeline.findStates(0.048), nullptr);
  EXPECT_NEAR(rig.keptX(0.016), 0.016, 1e-15);
  // The body has not moved meanwhile.
  EXPECT_NEAR(rig.island.state(rig.body).p_W.x(), 0.02, 1e-15);
}

// A cubic between two equal states with a velocity would go back and forth.
TEST(Timeline, StandsInLostTime) {
  MovingBody rig(1.0);
  rig.timeline.announce(0.016, 0.016);
  rig.runUntilTick(20);
  rig.timeline.lose(0.1);
  rig.tick = 100;
  for (const int ticks : {0, 1, 5}) {
    rig.runUntilTick(100 + ticks);
    for (const double time : {0.0201, 0.03, 0.05, 0.0999}) {
      const RigidState state = rig.timeline.stateAt(rig.body, time);
      EXPECT_NEAR(state.p_W.x(), 0.02, 1e-15) << time;
      EXPECT_NEAR(state.v_W.x(), 1.0, 1e-15) << time;
    }
    EXPECT_NEAR(rig.timeline.stateAt(rig.body, 0.0185).p_W.x(), 0.0185, 1e-15);
  }
  EXPECT_NEAR(rig.timeline.stateAt(rig.body, 0.1005).p_W.x(), 0.0205, 1e-15);
}

// A live host's first step may end before the tick that its haptic thread has reached.
TEST(Timeline, KnowsTheFirstTicksToo) {
  constexpr double kForce = 3.0;  // [N]
  MovingBody rig(0.2);
  rig.island.setExternalWrench(rig.body, Vec3(kForce, 0, 0), Vec3::Zero());
  rig.timeline.begin(0.0, 0.0);
  rig.runUntilTick(30);
  for (const double time : {0.0, 0.0015, 0.016, 0.0285}) {
    const RigidState state = rig.timeline.stateAt(rig.body, time);
    EXPECT_NEAR(state.p_W.x(), 0.2 * time + kForce / kMass * time * time / 2.0, 1e-14) << time;
    EXPECT_NEAR(state.v_W.x(), 0.2 + kForce / kMass * time, 1e-12) << time;
  }
}

// Before the first kept moment a turning body has turned less.
TEST(Timeline, TurnsABodyBackToBeforeAllMoments) {
  MovingBody rig(0.0);
  RigidState state = rig.island.state(rig.body);
  state.w_W = Vec3(0, 0, 2.0);
  rig.island.setState(rig.body, state);
  rig.runUntilTick(3);
  const Quat turned(Eigen::AngleAxisd(2.0 * 1.5e-3, Vec3::UnitZ()));
  EXPECT_LT(rig.timeline.stateAt(rig.body, 1.5e-3).q_WB.angularDistance(turned), 1e-9);
}

TEST(Timeline, AnnouncesTheFirstEndAfterTheIsland) {
  MovingBody rig(1.0);
  rig.runUntilTick(50);
  rig.timeline.announceAfterNow(0.012, 0.016);
  EXPECT_NEAR(rig.timeline.announcedEnd(), 0.06, 1e-15);
  rig.timeline.announceAfterNow(0.2, 0.016);
  EXPECT_EQ(rig.timeline.announcedEnd(), 0.2);
  // An end in the past is not announced.
  rig.timeline.announce(0.01, 0.016);
  EXPECT_EQ(rig.timeline.announcedEnd(), 0.2);
}

TEST(Timeline, MomentsOfASleepingIslandShareStatesThatStay) {
  MovingBody rig(0.0);
  rig.timeline.announce(0.01, 0.01);
  rig.runUntilTick(41);
  ASSERT_TRUE(rig.island.isAsleep());
  // A second rest, elsewhere, must not change what was kept of the first.
  RigidState state = rig.island.state(rig.body);
  state.p_W.x() = 2.0;
  rig.island.setState(rig.body, state);
  EXPECT_FALSE(rig.timeline.sleptSinceStart());
  rig.runUntilTick(81);
  ASSERT_TRUE(rig.island.isAsleep());
  for (int end = 1; end <= 8; ++end) EXPECT_EQ(rig.keptX(0.01 * end), end <= 4 ? 0.0 : 2.0) << end;
}

TEST(Timeline, ChangesTheBodyNowAndInLaterMoments) {
  MovingBody rig(0.0);
  rig.timeline.announce(0.01, 0.01);
  rig.runUntilTick(41);
  rig.timeline.changeAfter(0.02 + kClockTolerance, rig.body, [](RigidState state) {
    state.p_W.x() += 0.5;
    return state;
  });
  EXPECT_EQ(rig.keptX(0.01), 0.0);
  EXPECT_EQ(rig.keptX(0.02), 0.0);
  EXPECT_EQ(rig.keptX(0.03), 0.5);
  EXPECT_EQ(rig.keptX(0.04), 0.5);
  EXPECT_EQ(rig.island.state(rig.body).p_W.x(), 0.5);
}

}  // namespace
}  // namespace tandem
