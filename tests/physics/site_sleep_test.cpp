// A site at rest does no work, and any motion is felt as if the site had never slept.

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::FakeDevice;
using test::FakeLink;
using test::makePacket;

constexpr double kPeriod = 1e-3;  // haptic period [s]
constexpr int kTicksPerStep = 4;  // ticks of a host step: 250 Hz
constexpr double kHostStep = kTicksPerStep * kPeriod;
constexpr double kHalf = 0.02, kRadius = 0.01;  // cube, and device and proxy [m]
constexpr double kMass = 0.1;                   // mass of this copy of the cube [kg]
constexpr PeerId kRemote{2};
const Vec3 kAway(-0.2, 0, 0.1);  // position of the device away from the cube

struct Options {
  Vec3 gravity = Vec3(0, 0, -9.81);
  bool has_floor = true;
  bool is_restless = false;   ///< the device trembles, so nothing ever sleeps
  bool ticks_itself = false;  ///< the site ticks inside the host's steps
  SiteSettings settings;
};

/// A cube that rests on the floor (or floats), with a device and a remote user's proxy away from
/// it.
struct Rig {
  BulletRig host;
  btRigidBody* floor = nullptr;
  FakeDevice device{kAway};
  FakeLink link{100'000};
  btRigidBody& cube;
  std::unique_ptr<Site> site;
  bool is_restless, ticks_itself;
  std::uint64_t ticks = 0;

  explicit Rig(Options options = {})
      : host(options.gravity),
        cube(host.addCube(2 * kMass, kHalf, Vec3(0, 0, kHalf))),
        is_restless(options.is_restless),
        ticks_itself(options.ticks_itself) {
    if (options.has_floor)
      floor = &host.addBody(host.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0);
    options.settings.tick_source = ticks_itself ? TickSource::kHostStep : TickSource::kCaller;
    options.settings.host_step = kHostStep;
    site = std::make_unique<Site>(options.settings, host.world, device);
    site->share(cube);
    site->connect(kRemote, link, Vec3(0.3, 0, 0.1));
  }
  ~Rig() { site.reset(); }

  void tick() {
    if (is_restless) device.sample.hip.v_W.y() = ticks % 2 == 0 ? 1e-6 : -1e-6;
    EXPECT_EQ(site->tick(static_cast<double>(ticks++) * kPeriod), kTickOk);
  }
  void hostStep() {
    for (int i = 0; i < kTicksPerStep && !ticks_itself; ++i) tick();
    host.step(kHostStep);
  }
  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kHostStep) hostStep();
  }
  [[nodiscard]] const SiteCounters& counters() const { return site->counters(); }
  [[nodiscard]] const RigidState& object() const { return site->object(0); }
  [[nodiscard]] bool isCubeAsleep() const { return cube.getActivationState() == ISLAND_SLEEPING; }
  void fallAsleep() {
    run(1.0);
    const std::uint64_t before = counters().host_steps_skipped;
    run(2 * kHostStep);
    ASSERT_EQ(counters().host_steps_skipped, before + 2);
    ASSERT_TRUE(isCubeAsleep());
  }
};

SiteSettings withoutCouplers() {
  SiteSettings settings;
  settings.coordination = {0.0, 0.0};
  return settings;
}

Options inSpace() {
  Options options;
  options.gravity = Vec3::Zero();
  options.has_floor = false;
  options.settings = withoutCouplers();
  return options;
}

TEST(SiteSleep, NeitherSearchesNorHandsOffWhileNothingMoves) {
  Rig rig;
  rig.fallAsleep();
  const SiteCounters before = rig.counters();
  const RigidState object = rig.object();
  const btTransform pose = rig.cube.getWorldTransform();
  rig.run(1.0);
  const auto steps = static_cast<std::uint64_t>(std::lround(1.0 / kHostStep));
  EXPECT_EQ(rig.counters().host_steps - before.host_steps, steps);
  EXPECT_EQ(rig.counters().host_steps_skipped - before.host_steps_skipped, steps);
  EXPECT_EQ(rig.counters().searches, before.searches);
  EXPECT_EQ(rig.counters().bodies_handed_off, before.bodies_handed_off);
  EXPECT_EQ(rig.counters().bodies_woken, before.bodies_woken);
  EXPECT_EQ(rig.counters().packets_sent - before.packets_sent, 16u);  // peers still receive packets
  EXPECT_EQ(rig.object().p_W, object.p_W);
  EXPECT_TRUE(rig.cube.getWorldTransform() == pose);
}

TEST(SiteSleep, IdlePacketsSaySoAndTheFirstMotionIsSentInItsTick) {
  Rig rig;
  rig.fallAsleep();
  EXPECT_TRUE(rig.link.sent.back().is_idle);
  // This is between two due packets.
  const std::uint64_t sent = rig.counters().packets_sent;
  while (rig.counters().packets_sent == sent) rig.tick();
  for (int i = 0; i < 5; ++i) rig.tick();
  ASSERT_EQ(rig.counters().packets_sent, sent + 1);
  rig.device.sample.hip.p_W.y() += 1e-4;
  rig.tick();
  EXPECT_EQ(rig.counters().packets_sent, sent + 2);
  const StatePacket& woken = rig.link.sent.back();
  EXPECT_FALSE(woken.is_idle);
  EXPECT_EQ(woken.user.p_W, rig.device.sample.hip.p_W);
  EXPECT_EQ(woken.sequence, rig.link.sent[rig.link.sent.size() - 2].sequence + 1);
}

TEST(SiteSleep, GuidedSitesAreIdleToo) {
  Options options = inSpace();
  options.settings.guide = Vec3(1, 0, 0);
  Rig rig(options);
  rig.run(1.0);
  const std::uint64_t sent = rig.counters().packets_sent;
  rig.run(1.0);
  EXPECT_EQ(rig.counters().packets_sent - sent, 16u);
  EXPECT_TRUE(rig.link.sent.back().is_idle);
  rig.device.sample.hip.p_W.x() += 1e-4;
  rig.device.sample.hip.v_W.x() = 0.1;
  rig.tick();
  EXPECT_FALSE(rig.link.sent.back().is_idle);
  EXPECT_EQ(rig.link.sent.back().user.p_W, rig.device.sample.hip.p_W);
}

TEST(SiteSleep, SendsAllWhileIdleIfItIsAskedTo) {
  Options options;
  options.settings.thins_when_idle = false;
  Rig rig(options);
  rig.fallAsleep();
  const std::uint64_t sent = rig.counters().packets_sent;
  rig.run(1.0);
  EXPECT_EQ(rig.counters().packets_sent - sent, 128u);
  EXPECT_FALSE(rig.link.sent.back().is_idle);
}

TEST(SiteSleep, UntouchedBodiesSleepWhileTheDeviceMoves) {
  Options options;
  options.is_restless = true;
  Rig rig(options);
  rig.run(1.0);
  const SiteCounters before = rig.counters();
  rig.run(1.0);
  EXPECT_TRUE(rig.isCubeAsleep());
  EXPECT_EQ(rig.counters().host_steps_skipped, 0u);
  EXPECT_EQ(rig.counters().bodies_handed_off, before.bodies_handed_off);
}

TEST(SiteSleep, DeviceThatPressesIsFeltAsIfNothingHadSlept) {
  Options options;
  Rig asleep(options);
  options.is_restless = true;
  Rig awake(options);
  asleep.fallAsleep();
  while (awake.ticks < asleep.ticks) awake.hostStep();

  const auto press = [](Rig& rig) {
    rig.is_restless = false;
    rig.device.sample.hip = {Vec3(-kHalf - kRadius + 1e-3, 0, kHalf), Vec3(0.1, 0, 0)};
    rig.tick();
  };
  press(asleep), press(awake);
  EXPECT_LT(asleep.device.force_W.x(), -1.0);  // K times 1 mm and more
  EXPECT_GT(asleep.object().v_W.x(), 0.0);
  asleep.device.sample.hip.v_W.setZero();
  awake.device.sample.hip.v_W.setZero();
  for (int i = 0; i < 500; ++i) {
    asleep.tick(), awake.tick();
    if (i % kTicksPerStep == 2) {
      asleep.host.step(kHostStep), awake.host.step(kHostStep);
      ASSERT_LT((fromBullet(asleep.cube.getCenterOfMassPosition()) -
                 fromBullet(awake.cube.getCenterOfMassPosition()))
                    .norm(),
                byWidth(1e-9, 1e-7));
    }
    ASSERT_LT((asleep.object().p_W - awake.object().p_W).norm(), byWidth(1e-9, 1e-7)) << i;
    ASSERT_LT((asleep.device.force_W - awake.device.force_W).norm(), byWidth(1e-5, 1e-3)) << i;
  }
  EXPECT_GT(asleep.object().p_W.x(), 1e-4);
  EXPECT_EQ(asleep.counters().bodies_woken, 1u);  // the cube; the proxy stays asleep
}

TEST(SiteSleep, WokenByAPacketInItsTick) {
  Rig rig;
  rig.fallAsleep();
  StatePacket packet = makePacket(kRemote, 0, Vec3(0.3, 0, 0.1));
  packet.object_count = 1;
  packet.objects[0].state = rig.object();
  packet.objects[0].state.p_W.z() += 0.04;  // the other user has lifted it
  rig.link.arrivals.push_back({packet, static_cast<double>(rig.ticks) * kPeriod});
  rig.tick();
  // 8 N upwards on 0.1 kg, minus its weight.
  EXPECT_NEAR(rig.object().v_W.z(), (200.0 * 0.04 / kMass - 9.81) * kPeriod, 0.02);
  for (int i = 1; i < kTicksPerStep; ++i) rig.tick();
  const double end = rig.object().p_W.z();
  rig.host.step(kHostStep);
  EXPECT_FALSE(rig.isCubeAsleep());
  EXPECT_NEAR(static_cast<double>(rig.cube.getCenterOfMassPosition().z()), end,
              byWidth(1e-12, 1e-8));
}

TEST(SiteSleep, SamePacketsDoNotWake) {
  Rig rig;
  rig.fallAsleep();
  const std::uint64_t before = rig.counters().host_steps_skipped;
  for (std::uint64_t n = 0; n < 100; ++n) {
    rig.link.arrivals.push_back(
        {makePacket(kRemote, n, Vec3(0.3, 0, 0.1)), static_cast<double>(rig.ticks) * kPeriod});
    rig.hostStep();
  }
  EXPECT_EQ(rig.counters().packets_taken, 100u);
  EXPECT_EQ(rig.counters().host_steps_skipped, before + 100);
}

// The host pushes a body without asking whether it sleeps.
TEST(SiteSleep, WokenByAForceOfTheHost) {
  Rig rig(inSpace());
  rig.fallAsleep();
  for (int i = 0; i < kTicksPerStep; ++i) rig.tick();
  rig.cube.applyCentralForce(btVector3(0, 2, 0));
  rig.host.step(kHostStep);
  rig.tick();
  EXPECT_GT(rig.object().v_W.y(), 0.0);
  for (int i = 1; i < kTicksPerStep; ++i) rig.tick();
  rig.host.step(kHostStep);
  rig.run(10 * kHostStep);
  EXPECT_NEAR(rig.object().v_W.y(), 2.0 * kHostStep / kMass, byWidth(1e-12, 1e-8));
}

TEST(SiteSleep, WokenByAnImpulseAndATeleportOfTheHost) {
  Rig rig(inSpace());
  rig.fallAsleep();
  rig.cube.setLinearVelocity(btVector3(0, 0, btScalar(0.25)));
  rig.hostStep();
  EXPECT_NEAR(rig.object().v_W.z(), 0.25, byWidth(1e-15, 1e-8));

  Rig moved(inSpace());
  moved.fallAsleep();
  btTransform pose = moved.cube.getWorldTransform();
  pose.setOrigin(pose.getOrigin() + btVector3(btScalar(0.5), 0, 0));
  moved.cube.setWorldTransform(pose);
  moved.hostStep();
  EXPECT_NEAR(moved.object().p_W.x(), 0.5, byWidth(1e-15, 1e-7));
  moved.run(0.1);
  EXPECT_TRUE(moved.isCubeAsleep());  // the cube stands there, and sleeps again
  EXPECT_NEAR(static_cast<double>(moved.cube.getCenterOfMassPosition().x()), 0.5,
              byWidth(1e-15, 1e-7));
}

TEST(SiteSleep, WakesInTheHostsStepIfItTicksThere) {
  Options options;
  options.ticks_itself = true;
  options.settings = withoutCouplers();
  Rig rig(options);
  rig.fallAsleep();
  // The device comes down on the cube, and feels it within the same step.
  rig.device.sample.hip.p_W = Vec3(0, 0, 2 * kHalf + kRadius - 1e-3);
  rig.hostStep();
  EXPECT_GT(rig.site->force().z(), 1.0);
  EXPECT_EQ(rig.site->status(), kTickOk);
  rig.device.sample.hip.p_W = kAway;
  rig.run(0.1);
  rig.fallAsleep();
  // An impulse of the host, which need not wake the cube.
  rig.cube.setLinearVelocity(btVector3(0, 0, btScalar(0.5)));
  rig.hostStep();
  EXPECT_NEAR(rig.object().v_W.z(), 0.5 - 9.81 * kHostStep, 0.05);
  EXPECT_FALSE(rig.isCubeAsleep());
}

TEST(SiteSleep, WeightOfAWokenBodyIsNotFeltTwice) {
  Rig rig;
  rig.fallAsleep();
  rig.cube.activate(true);
  rig.run(0.1);
  const double height = rig.object().p_W.z();
  EXPECT_NEAR(height, kHalf, 1e-6);
  rig.run(0.2);
  EXPECT_TRUE(rig.isCubeAsleep());
  EXPECT_NEAR(rig.object().p_W.z(), height, 1e-12);
}

// A body that only the host knows hits the cube. Bullet wakes ours, and the island has the
// momentum.
TEST(SiteSleep, WokenByWhatHitsItInBullet) {
  for (const int sub_steps : {1, 4}) {
    Rig rig(inSpace());
    rig.fallAsleep();
    btRigidBody& ball = rig.host.addBody(rig.host.makeShape<btSphereShape>(btScalar(0.01)), 0.05,
                                         Vec3(0, 0.1, kHalf));
    ball.setLinearVelocity(btVector3(0, -1, 0));
    // The ball is new to the world, so all bodies are checked once more. It is still far away.
    const auto momentum = [&] {
      return 0.05 * static_cast<double>(ball.getLinearVelocity().y()) +
             kMass * rig.object().v_W.y();
    };
    bool hit = false;
    for (int i = 0; i < 60 && !hit; ++i) {
      for (int k = 0; k < kTicksPerStep; ++k) rig.tick();
      rig.host.world.stepSimulation(static_cast<btScalar>(kHostStep), sub_steps,
                                    static_cast<btScalar>(kHostStep / sub_steps));
      hit = rig.object().v_W.y() != 0.0;
    }
    ASSERT_TRUE(hit);
    EXPECT_FALSE(rig.isCubeAsleep());
    rig.run(0.05);
    EXPECT_NEAR(momentum(), -0.05, byWidth(1e-9, 1e-6)) << sub_steps;
    EXPECT_LT(rig.object().v_W.y(), -0.1);
  }
}

TEST(SiteSleep, FallsWhenItsFloorIsTakenAway) {
  Options options;
  options.settings = withoutCouplers();
  for (const bool is_moved : {false, true}) {
    Rig rig(options);
    rig.fallAsleep();
    if (is_moved) {
      rig.floor->getWorldTransform().setOrigin(btVector3(0, 0, -1));
    } else {
      rig.host.world.removeRigidBody(rig.floor);
    }
    rig.hostStep();
    rig.tick();
    EXPECT_NEAR(rig.object().v_W.z(), -9.81 * kPeriod, byWidth(1e-9, 1e-7));
    for (int k = 1; k < kTicksPerStep; ++k) rig.tick();
    rig.host.step(kHostStep);
    rig.run(0.1);
    EXPECT_NEAR(rig.object().p_W.z(), kHalf - 0.5 * 9.81 * 0.104 * 0.104, 1e-5);
    EXPECT_LT((fromBullet(rig.cube.getCenterOfMassPosition()) - rig.object().p_W).norm(),
              byWidth(1e-9, 1e-7));
  }
}

TEST(SiteSleep, FallsWhenTheWorldGetsAnotherGravity) {
  Rig rig(inSpace());
  rig.fallAsleep();
  rig.host.world.setGravity(btVector3(0, 3, 0));
  rig.run(0.1);
  EXPECT_NEAR(rig.object().v_W.y(), 0.3, 3.0 * 2 * kHostStep);
  const Vec3 v_W = rig.object().v_W;
  rig.run(0.1);
  EXPECT_NEAR(rig.object().v_W.y() - v_W.y(), 0.3, byWidth(1e-9, 1e-6));
}

TEST(SiteSleep, AQuietSiteWithANeighbourMayBeGivenAnotherObject) {
  Rig rig({.gravity = Vec3::Zero(), .has_floor = false, .settings = {}});
  rig.host.addCube(kMass, kHalf, Vec3(2.05 * kHalf, 0, kHalf));
  btRigidBody& other = rig.host.addCube(kMass, kHalf, Vec3(0.5, 0, kHalf));
  for (int i = 0; i < 2000 && rig.site->counters().host_steps_skipped == 0; ++i) rig.hostStep();
  ASSERT_GT(rig.site->counters().host_steps_skipped, 0u);
  ASSERT_GT(rig.site->neighbourCount(), 0);
  rig.site->share(other);
  for (int i = 0; i < 20; ++i) rig.hostStep();
  EXPECT_EQ(rig.site->status(), kTickOk);
}

TEST(SiteSleep, BodyTakenOutIsNoticed) {
  Rig rig;
  rig.fallAsleep();
  rig.host.world.removeRigidBody(&rig.cube);
  rig.host.step(kHostStep);
  EXPECT_EQ(rig.site->status(), kBodyMissing);
  rig.host.world.addRigidBody(&rig.cube);
}

TEST(SiteSleep, EndGivesBodiesBackAwakeAsTheyWere) {
  Rig rig;
  rig.fallAsleep();
  rig.site.reset();
  EXPECT_EQ(rig.cube.getActivationState(), ACTIVE_TAG);
}

}  // namespace
}  // namespace tandem
