#include "tandem/plugin/haptic_loop.h"

#include <cmath>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "thread/live_rig.h"

namespace tandem {
namespace {

using test::LiveSite;
using test::Wire;

/// Settings that need no privileges and tolerate a busy machine.
constexpr HapticLoopSettings kModest{.priority = 0, .locks_memory = false, .begin = {}};
/// Limits of the force: a rise of 2 N per tick, 8 N in all, plus rounding.
constexpr double kMostRise = 2.0 + 1e-9, kMostForce = 8.0 + 1e-9;

void expectSafe(const test::WatchedDevice& device) {
  EXPECT_TRUE(device.is_finite);
  EXPECT_LE(device.largest, kMostForce);
  EXPECT_LE(device.largest_rise, kMostRise);
  EXPECT_EQ(device.last_W, Vec3(Vec3::Zero())) << "the hand was let go with a force on it";
}

/// Distance between the cube in Bullet and in the island [m].
double distanceToBullet(const LiveSite& live) {
  return (live.site->object(0).p_W - fromBullet(live.cube->getCenterOfMassPosition())).norm();
}

TEST(HapticLoop, TwoSitesPushACubeAmongBoxesWhileTheirHostsStep) {
  LiveSite one(1, Vec3(0.0, 2.0, 0.0)), two(2, Vec3(-1.0, 0.0, 0.0));
  {
    const Wire wire(one.queue, two.queue);
    HapticLoop loop_one(*one.site, kModest), loop_two(*two.site, kModest);
    std::thread other([&] { two.host(2.0); });
    one.host(2.0);
    other.join();
    EXPECT_GT(loop_one.report().ticks, 0u);
  }
  for (const LiveSite* live : {&one, &two}) {
    expectSafe(live->watched);
    EXPECT_GT(live->watched.largest, 0.0);
    EXPECT_EQ(live->site->status(), kTickOk);
    EXPECT_GT(live->site->counters().promoted, 0u);
    EXPECT_GT(live->site->counters().packets_taken, 0u);
    EXPECT_TRUE(isFinite(live->site->object(0)));
  }
  // Both cubes were pushed away from their start, to about the same place.
  EXPECT_GT(one.site->object(0).p_W.y(), 0.005);
  EXPECT_NEAR(one.site->object(0).p_W.y(), two.site->object(0).p_W.y(), 0.03);
}

// Each begins alone. They share the cube while they hear each other, and part again.
TEST(HapticLoop, UsersComeAndGoWhileTheirHostsStep) {
  constexpr MembershipSettings kFollows{true, 0.3};
  LiveSite one(1, Vec3(0.0, 2.0, 0.0), 3, nullptr, kFollows);
  LiveSite two(2, Vec3(-1.0, 0.0, 0.0), 3, nullptr, kFollows);
  const auto expectMass = [&](double mass) {
    for (const LiveSite* live : {&one, &two})
      EXPECT_NEAR(1.0 / static_cast<double>(live->cube->getInvMass()), mass, 1e-6);
  };
  {
    HapticLoop loop_one(*one.site, kModest), loop_two(*two.site, kModest);
    const auto step = [&](double seconds) {
      std::thread other([&] { two.host(seconds); });
      one.host(seconds);
      other.join();
    };
    step(0.3);
    expectMass(0.2);
    {
      const Wire wire(one.queue, two.queue);
      step(1.5);
      expectMass(0.1);
    }
    step(1.5);
    expectMass(0.2);
  }
  for (const LiveSite* live : {&one, &two}) {
    expectSafe(live->watched);
    EXPECT_EQ(live->site->status(), kTickOk);
    EXPECT_EQ(live->site->counters().members_changed, 2u);
  }
}

/// A step of the host asks the haptic thread, and waits for its answer.
TEST(HapticLoop, OneHostThreadStepsTwoSitesAt240Hz) {
  LiveSite one(1, Vec3(0.0, 2.0, 0.0)), two(2, Vec3(-1.0, 0.0, 0.0));
  constexpr double kStep = 1.0 / 240.0, kDuration = 2.0;
  {
    const Wire wire(one.queue, two.queue);
    HapticLoop loop_one(*one.site, kModest), loop_two(*two.site, kModest);
    const double begin = readMonotonicClock();
    for (int step = 1; step <= static_cast<int>(kDuration / kStep); ++step) {
      sleepUntil(begin + step * kStep);
      for (LiveSite* live : {&one, &two})
        live->rig.world.stepSimulation(static_cast<btScalar>(kStep), 0);
    }
  }
  for (const LiveSite* live : {&one, &two}) {
    expectSafe(live->watched);
    EXPECT_EQ(live->site->status(), kTickOk);
    EXPECT_LT(distanceToBullet(*live), 5e-3);
  }
  EXPECT_LT((one.site->object(0).p_W - two.site->object(0).p_W).norm(), 0.03);
}

TEST(HapticLoop, GivesBulletWhereTheIslandIs) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0), 0);
  HapticLoop loop(*live.site, kModest);
  live.host(1.0);
  loop.stop();
  // The host makes one more step without the thread, so nothing moves in between.
  live.rig.world.stepSimulation(static_cast<btScalar>(LiveSite::kHostPeriod), 0);
  // The host is at most a step and a half behind, at less than 0.3 m/s.
  EXPECT_LT(distanceToBullet(live), 0.3 * 1.5 * LiveSite::kHostPeriod + 1e-3);
}

TEST(HapticLoop, LeavesBodiesToBulletOnceStopped) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0));
  HapticLoop loop(*live.site, kModest);
  live.host(0.5);
  loop.stop();
  EXPECT_TRUE(live.site->isHeld(0));
  // The host may be a step and a half behind.
  live.host(4.0 * LiveSite::kHostPeriod);
  EXPECT_FALSE(live.site->isHeld(0));
  EXPECT_EQ(live.site->neighbourCount(), 0);
}

TEST(HapticLoop, AHostThatStopsForTwoSecondsIsNotFeltAndPutsNothingWhereItNeverWas) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0), 0);  // no boxes, so the cube keeps moving
  HapticLoop loop(*live.site, kModest);
  live.host(0.5);
  std::this_thread::sleep_for(std::chrono::seconds(2));
  double farthest = 0.0, least = 0.0;
  for (int step = 0; step < 60; ++step) {
    live.host(LiveSite::kHostPeriod);
    const double y = static_cast<double>(live.cube->getCenterOfMassPosition().y());
    farthest = std::max(farthest, y);
    least = std::min(least, y);
  }
  loop.stop();
  expectSafe(live.watched);
  EXPECT_GT(live.watched.largest, 0.0);
  EXPECT_EQ(live.site->status(), kTickOk);
  EXPECT_GT(farthest, 0.02) << "the cube was to move";
  EXPECT_GT(least, -1e-3);
  EXPECT_LT(farthest, live.site->object(0).p_W.y() + 1e-3);
}

TEST(HapticLoop, AHostTwiceAsFastAsTimeGetsWhatIsNow) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0), 0);
  HapticLoop loop(*live.site, kModest);
  live.host(3.0, 2.0);
  loop.stop();
  expectSafe(live.watched);
  EXPECT_EQ(live.site->status(), kTickOk);
  // The host is a step behind and the last tick ahead, at less than 0.3 m/s.
  EXPECT_LT(distanceToBullet(live), 0.01);
}

TEST(HapticLoop, AHostHalfAsFastAsTimeIsSetOn) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0), 0);
  HapticLoop loop(*live.site, kModest);
  live.host(2.0, 0.5);
  loop.stop();
  expectSafe(live.watched);
  EXPECT_EQ(live.site->status(), kTickOk);
  EXPECT_GT(live.site->counters().host_clock_set, 0u);
  // The host falls behind by one second in two. Its clock is set forward once per second of the
  // host.
  EXPECT_LT(distanceToBullet(live), 0.3 * 2.0);
}

TEST(HapticLoop, AnUnpluggedDeviceHasNoForceAndComesBack) {
  LiveSite live(1, Vec3(0.0, 2.0, 0.0));
  HapticLoop loop(*live.site, kModest);
  live.host(0.5);
  live.watched.is_unplugged = true;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  Vec3 felt_W = Vec3::Ones();
  live.site->betweenTicks([&] { felt_W = live.watched.last_W; });
  EXPECT_EQ(felt_W, Vec3(Vec3::Zero()));
  live.watched.is_unplugged = false;
  live.host(0.5);
  loop.stop();
  expectSafe(live.watched);
  EXPECT_EQ(live.site->status(), static_cast<std::uint32_t>(kDeviceInvalid));
}

TEST(HapticLoop, SkipsTicksWhoseTimeHasPassedAndMovesOverThem) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  live.watched.dawdles_every = 50;
  HapticLoop loop(*live.site, kModest);
  live.host(1.0);
  loop.stop();
  const LoopReport report = loop.report();
  EXPECT_GT(report.skipped, 0u);
  EXPECT_GT(report.longest_gap, 4e-3);
  // Bodies are advanced over each skipped tick, except in gaps above 0.1 s.
  EXPECT_GT(live.site->counters().ticks_made_up, 0u);
  EXPECT_LE(live.site->counters().ticks_made_up, report.skipped);
  EXPECT_EQ(live.site->tickCount(), report.ticks);
  expectSafe(live.watched);
}

TEST(HapticLoop, WhoIsLateAgainAndAgainMakesUpForNothing) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  live.watched.dawdles_every = 1;  // each tick lasts five periods
  HapticLoop loop(*live.site, kModest);
  live.host(1.0);
  loop.stop();
  // Only the first gap is made up, and gaps after a tick that happened to be in time.
  EXPECT_GT(loop.report().skipped, 100u);
  EXPECT_LT(live.site->counters().ticks_made_up, loop.report().skipped / 4);
  expectSafe(live.watched);
}

TEST(HapticLoop, IsSetUpBefore) {
  LiveSite live(1, Vec3::Zero());
  btRigidBody& other = live.rig.addCube(0.2, 0.02, Vec3(0.5, 0.0, 0.0));
  HapticLoop loop(*live.site, kModest);
  EXPECT_THROW((void)live.site->share(other), Error);
  loop.stop();
  EXPECT_EQ(live.site->share(other), 1);
}

TEST(HapticLoop, ABeginningThatLiesAheadKeepsNobodyWaiting) {
  LiveSite live(1, Vec3::Zero());
  HapticLoopSettings later = kModest;
  later.begin = readMonotonicClock() + 3600.0;
  HapticLoop loop(*live.site, later);
  live.host(0.1);
  loop.stop();
  EXPECT_EQ(loop.report().ticks, 0u);
  later.begin = std::nan("");
  EXPECT_THROW(HapticLoop(*live.site, later), std::invalid_argument);
}

TEST(HapticLoop, ABodyMayBeDeletedWithItsShape) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  auto shape = std::make_unique<btSphereShape>(btScalar(0.02));
  auto& rigid = live.rig.addBody(*shape, 0.1, Vec3(0.045, 0.0, 0.0));
  auto owned = std::move(live.rig.bodies.back());
  live.rig.bodies.pop_back();
  HapticLoop loop(*live.site, kModest);
  live.host(0.2);
  live.rig.world.removeRigidBody(&rigid);
  owned.reset();
  shape.reset();
  live.host(0.2);
  loop.stop();
  EXPECT_EQ(live.site->status(), kTickOk);
}

TEST(HapticLoop, AnObjectIsUnsharedAndItsBodyDeletedAtOnce) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  HapticLoop loop(*live.site, kModest);
  live.host(0.1);
  for (int round = 0; round < 3; ++round) {
    auto shape =
        std::make_unique<btBoxShape>(btVector3(btScalar(0.02), btScalar(0.02), btScalar(0.02)));
    auto& rigid = live.rig.addBody(*shape, 0.2, Vec3(0.0, 0.0, 0.05));
    auto owned = std::move(live.rig.bodies.back());
    live.rig.bodies.pop_back();
    live.site->unshare(0);
    EXPECT_EQ(live.cube->getInvMass(), btScalar(1) / btScalar(0.2));
    live.site->share(0, rigid);
    live.host(0.1);
    EXPECT_TRUE(live.site->isHeld(0));
    live.site->unshare(0);
    live.rig.world.removeRigidBody(&rigid);
    owned.reset();
    shape.reset();
    live.site->share(0, *live.cube);
    live.host(0.1);
    EXPECT_TRUE(live.site->isHeld(0));
  }
  loop.stop();
  EXPECT_EQ(live.site->status(), kTickOk);
  expectSafe(live.watched);
}

TEST(HapticLoop, AnyThreadMayLookBetweenTicks) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  HapticLoop loop(*live.site, kModest);
  std::uint64_t seen = 0, seen_by_other = 0;
  std::thread other([&] {
    for (int i = 0; i < 50; ++i)
      live.site->betweenTicks([&] { seen_by_other = live.site->tickCount(); });
  });
  for (int i = 0; i < 50; ++i) live.site->betweenTicks([&] { seen = live.site->tickCount(); });
  other.join();
  loop.stop();
  EXPECT_GT(seen, 0u);
  EXPECT_GT(seen_by_other, 0u);
  EXPECT_GE(live.site->tickCount(), std::max(seen, seen_by_other));
}

TEST(HapticLoop, StartsAgain) {
  LiveSite live(1, Vec3(0.0, 1.0, 0.0));
  std::uint64_t ticks = 0;
  for (int round = 0; round < 3; ++round) {
    HapticLoop loop(*live.site, kModest);
    live.host(0.2);
    loop.stop();
    EXPECT_GT(live.site->tickCount(), ticks);
    ticks = live.site->tickCount();
  }
  expectSafe(live.watched);
}

TEST(HapticLoop, RefusesWhatItCannotTick) {
  LiveSite live(1, Vec3::Zero());
  EXPECT_THROW(HapticLoop(*live.site, {.priority = 100, .locks_memory = false, .begin = {}}),
               std::invalid_argument);
  const HapticLoop loop(*live.site, kModest);
  EXPECT_THROW(HapticLoop(*live.site, kModest), std::invalid_argument);

  test::BulletRig rig;
  SimulatedDevice device({}, makeConstantHand(Vec3::Zero()));
  Site stepped({}, rig.world, device);
  EXPECT_THROW(HapticLoop{stepped}, std::invalid_argument);
}

}  // namespace
}  // namespace tandem
