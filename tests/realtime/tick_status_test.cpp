// When a fault occurs, a tick reports it and the hand is safe.

#include <cmath>
#include <limits>
#include <memory>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "demos/program/run/virtual_run.h"
#include "support/checkout.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::FakeDevice;
using test::FakeLink;
using test::makePacket;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kPeriod = 1e-3;       // [s]
constexpr double kStiffness = 4000.0;  // [N/m]
constexpr double kRadius = 0.01;       // radius of device and proxy [m]
constexpr double kHalf = 0.02;         // half an edge of the cube [m]
constexpr double kTouch = kHalf + kRadius;
constexpr PeerId kRemote{2};
/// The cube's size has btScalar's rounding: in float about 1e-9 m of 2 cm, times the stiffness [N].
constexpr double kForceRounding = test::byWidth(1e-9, 1e-5);

/// One site with a cube at the origin, a device held by the test and a remote user out of reach.
struct Rig {
  BulletRig host;
  FakeDevice device{Vec3(-kTouch, 0, 0)};
  FakeLink link{10'000};
  btRigidBody& cube = host.addCube(0.2, kHalf);
  std::unique_ptr<Site> site;
  std::uint64_t ticks = 0;

  explicit Rig(SiteSettings settings = {}, double device_limit = 0.0) {
    if (device_limit > 0.0) device.limits.max_force = device_limit;
    settings.tick_source = TickSource::kCaller;
    site = std::make_unique<Site>(settings, host.world, device);
    site->share(cube);
    site->connect(kRemote, link, Vec3(0.5, 0, 0));
  }
  ~Rig() { site.reset(); }

  [[nodiscard]] double now() const { return static_cast<double>(ticks) * kPeriod; }
  std::uint32_t tick() { return site->tick(static_cast<double>(ticks++) * kPeriod); }
  void put(const StatePacket& packet) { link.arrivals.push_back({packet, now()}); }
  /// Puts the device this deep into the cube, along x, for one tick; the cube follows slowly.
  std::uint32_t press(double depth) {
    if (ticks == 0) tick();  // a hand that starts in the cube would be let in gently
    device.sample.hip.p_W = Vec3(-kTouch + depth, 0, 0);
    return tick();
  }
};

SiteSettings inSlot() {
  SiteSettings settings;
  settings.guide = Vec3::UnitX();
  return settings;
}

// Packets.

TEST(TickStatus, RefusesPacketsThatHoldNonsense) {
  StatePacket not_finite = makePacket(kRemote, 0, Vec3(kNan, 0, 0));
  StatePacket infinite = makePacket(kRemote, 0, Vec3::Zero());
  infinite.user.v_W.y() = std::numeric_limits<double>::infinity();
  StatePacket no_rotation = makePacket(kRemote, 0, Vec3::Zero());
  no_rotation.object_count = 1;
  no_rotation.objects[0].state.q_WB = Quat(1.1, 0, 0, 0);
  StatePacket object_not_finite = makePacket(kRemote, 0, Vec3::Zero());
  object_not_finite.object_count = 1;
  object_not_finite.objects[0].state.w_W.z() = kNan;
  StatePacket too_many = makePacket(kRemote, 0, Vec3::Zero());
  too_many.object_count = kMaxObjectsPerPacket + 1;
  const StatePacket stranger = makePacket(PeerId{3}, 0, Vec3::Zero());
  const StatePacket own = makePacket(PeerId{1}, 0, Vec3::Zero());

  Rig rig, undisturbed;
  std::uint64_t refused = 0;
  for (const StatePacket& packet :
       {not_finite, infinite, no_rotation, object_not_finite, too_many, stranger, own}) {
    rig.put(packet);
    EXPECT_EQ(rig.tick(), kPacketRefused) << "packet " << refused;
    undisturbed.tick();
    EXPECT_EQ(rig.site->counters().packets_refused, ++refused);
  }
  EXPECT_EQ(rig.site->counters().packets_taken, 0u);
  EXPECT_EQ(rig.site->stateHash(), undisturbed.site->stateHash());
  EXPECT_EQ(rig.tick(), kTickOk);  // each bit belongs to its own tick
  EXPECT_EQ(rig.site->status(), kPacketRefused);
}

TEST(TickStatus, ARefusedPacketDoesNotHideAGoodOne) {
  Rig rig;
  rig.put(makePacket(kRemote, 9, Vec3(kNan, 0, 0)));
  rig.put(makePacket(kRemote, 4, Vec3(0.4, 0, 0)));
  EXPECT_EQ(rig.tick(), kPacketRefused);
  EXPECT_EQ(rig.site->counters().packets_taken, 1u);
  EXPECT_EQ(rig.site->latest(0).sequence, 4u);
  EXPECT_EQ(rig.site->latest(0).user.p_W, Vec3(0.4, 0, 0));
}

TEST(TickStatus, DropsAndCountsStalePackets) {
  Rig rig;
  for (const std::uint64_t sequence : {5u, 3u, 5u, 6u, 0u, 8u, 7u})
    rig.put(makePacket(kRemote, sequence, Vec3(0.001 * static_cast<double>(sequence), 0, 0)));
  EXPECT_EQ(rig.tick(), kTickOk);                     // late packets are normal in a network
  EXPECT_EQ(rig.site->counters().packets_taken, 3u);  // 5, 6, 8
  EXPECT_EQ(rig.site->counters().packets_stale, 4u);
  EXPECT_EQ(rig.site->latest(0).sequence, 8u);
}

TEST(TickStatus, IgnoresObjectsThatAreNotShared) {
  Rig rig, undisturbed;
  StatePacket packet = makePacket(kRemote, 0, Vec3(0.5, 0, 0));
  undisturbed.put(packet);
  packet.object_count = 2;
  packet.objects[0].id = 77;
  packet.objects[1].id = std::numeric_limits<ObjectId>::max();
  packet.objects[0].state.p_W = packet.objects[1].state.p_W = Vec3(1, 1, 1);
  rig.put(packet);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(rig.tick(), undisturbed.tick());
  EXPECT_EQ(rig.site->stateHash(), undisturbed.site->stateHash());
}

TEST(TickStatus, SendsAtThePacketRate) {
  SiteSettings settings;
  settings.thins_when_idle = false;  // no body moves here
  Rig rig(settings);
  for (int i = 0; i < 1000; ++i) rig.tick();
  // One second of 128 packets per second; the first is sent at once.
  EXPECT_EQ(rig.site->counters().packets_sent, 128u);
  ASSERT_EQ(rig.link.sent.size(), 128u);
  for (std::size_t i = 0; i < 128; ++i) {
    EXPECT_EQ(rig.link.sent[i].sequence, i);
    EXPECT_EQ(rig.link.sent[i].sender, PeerId{1});
    EXPECT_NEAR(rig.link.sent[i].time, static_cast<double>(i) / 128.0, 1e-12);
  }
}

// The device.

// Presses with 8 N, then the device gives no valid sample. 2000 N/s are 2 N per tick.
void expectFade(const DeviceSample& bad) {
  Rig rig(inSlot());
  EXPECT_EQ(rig.press(0.002), kTickOk);
  double last = rig.device.force_W.norm();
  ASSERT_NEAR(last, kStiffness * 0.002, kForceRounding);
  rig.device.sample = bad;
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(rig.tick(), kDeviceInvalid);
    const double expected = std::max(0.0, last - 2.0);
    EXPECT_NEAR(rig.device.force_W.norm(), expected, 1e-9) << "tick " << i;
    EXPECT_LE(rig.device.force_W.x(), 0.0);  // the direction stays
    last = rig.device.force_W.norm();
  }
  EXPECT_EQ(last, 0.0);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(rig.tick(), kDeviceInvalid);
    EXPECT_EQ(rig.device.force_W, Vec3::Zero());
  }
  EXPECT_TRUE(isFinite(rig.site->hip()));
  EXPECT_TRUE(isFinite(rig.site->object(0)));
  EXPECT_EQ(rig.site->status(), kDeviceInvalid);
}

TEST(TickStatus, ForceFadesWhenTheDeviceIsGone) { expectFade({{}, false}); }

TEST(TickStatus, ForceFadesWhenTheDeviceGivesNan) {
  expectFade({{Vec3(kNan, 0, 0), Vec3::Zero()}, true});
  expectFade({{Vec3::Zero(), Vec3(0, 0, kNan)}, true});
  expectFade({{Vec3(0, std::numeric_limits<double>::infinity(), 0), Vec3::Zero()}, true});
}

TEST(TickStatus, DeviceThatIsGoneStaysWhereItWas) {
  Rig rig(inSlot());
  rig.device.sample.hip = {Vec3(-0.1, 0, 0), Vec3(0.5, 0, 0)};  // moving towards the cube
  rig.tick();
  rig.device.sample.valid = false;
  for (int i = 0; i < 500; ++i) rig.tick();
  // The device was read once at 0.5 m/s. The hand moves no further than to the next tick.
  EXPECT_LE(rig.site->hip().p_W.x(), -0.1 + 0.5 * kPeriod + 1e-12);
  EXPECT_EQ(rig.site->object(0).p_W, Vec3::Zero());
  EXPECT_EQ(rig.link.sent.back().user.v_W, Vec3::Zero());
}

TEST(TickStatus, DeviceThatComesBackIsFeltAgain) {
  Rig rig(inSlot());
  rig.press(0.002);
  rig.device.sample.valid = false;
  for (int i = 0; i < 10; ++i) rig.tick();
  rig.device.sample = {{Vec3(rig.site->object(0).p_W.x() - kTouch + 0.001, 0, 0), Vec3::Zero()},
                       true};
  EXPECT_EQ(rig.tick(), kTickOk);
  EXPECT_NE(rig.device.force_W, Vec3::Zero());
}

TEST(TickStatus, ForceLimitOfTheDeviceKeepsTheDirection) {
  const Vec3 on_the_edge(-kHalf - 0.003, -kHalf - 0.005,
                         0.001);  // touches two faces: an oblique force
  SiteSettings settings;
  settings.contact = {kStiffness, 0.0};
  settings.max_slew = std::numeric_limits<double>::infinity();
  Rig free(settings), limited(settings, 3.0), strong(settings, 1000.0);
  for (Rig* rig : {&free, &limited, &strong}) {
    EXPECT_EQ(rig->tick(), kTickOk);
    rig->device.sample.hip.p_W = on_the_edge;
    EXPECT_EQ(rig->tick(), kTickOk);
  }
  const Vec3 wanted_W = free.device.force_W;
  // The distance from the edge line is sqrt(3^2 + 5^2) mm; the sphere has 10 mm.
  EXPECT_NEAR(wanted_W.norm(), kStiffness * (kRadius - std::hypot(0.003, 0.005)), kForceRounding);
  EXPECT_NEAR(limited.device.force_W.norm(), 3.0, 1e-12);
  EXPECT_LT((limited.device.force_W.normalized() - wanted_W.normalized()).norm(), 1e-12);
  EXPECT_EQ(strong.device.force_W, wanted_W);
  EXPECT_EQ(limited.site->force(), limited.device.force_W);
}

// The host.

// A body is removed: the force fades, the island stops, and every later tick reports it.
void expectStopWithout(bool takes_proxy) {
  Rig rig(inSlot());
  const double host_step = 4 * kPeriod;
  const auto run = [&](int host_steps) {
    std::uint32_t status = kTickOk;
    for (int i = 0; i < host_steps; ++i) {
      for (int k = 0; k < 4; ++k) status |= rig.press(0.003);
      rig.host.step(host_step);
    }
    return status;
  };
  EXPECT_EQ(run(2), kTickOk);
  btRigidBody& body = takes_proxy ? *rig.site->proxyBody(0) : rig.cube;
  rig.host.world.removeRigidBody(&body);
  rig.host.step(host_step);
  ASSERT_TRUE(rig.site->status() & kBodyMissing);

  const RigidState cube = rig.site->object(0);
  double last = rig.site->force().norm();
  ASSERT_GT(last, 1.0);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(rig.press(0.004), kBodyMissing);
    EXPECT_NEAR(rig.site->force().norm(), std::max(0.0, last - 2.0), 1e-9);
    last = rig.site->force().norm();
    if (i % 4 == 3) rig.host.step(host_step);
  }
  EXPECT_EQ(last, 0.0);
  EXPECT_EQ(rig.site->object(0).p_W, cube.p_W);
  if (!takes_proxy) rig.host.world.addRigidBody(&body);  // lets the rig end as it began
}

TEST(TickStatus, StopsWhenTheProxysBodyIsTakenOut) { expectStopWithout(true); }
TEST(TickStatus, StopsWhenASharedBodyIsTakenOut) { expectStopWithout(false); }

TEST(TickStatus, SaysThatAHostStepsWronglyForImpulses) {
  SiteSettings settings = inSlot();
  settings.injection = Injection::kImpulse;
  Rig rig(settings);
  rig.tick();
  rig.host.step(kPeriod);
  EXPECT_EQ(rig.site->status(), kTickOk);
  rig.tick();
  rig.host.step(4 * kPeriod);
  EXPECT_EQ(rig.site->status(), kHostStepWrong);
}

// Gains far beyond the limit of the inner step, outside any slot.
TEST(TickStatus, StateThatIsNotFiniteEndsWithoutForce) {
  Rig rig;
  rig.press(0.002);
  StatePacket packet = makePacket(kRemote, 0, Vec3(0.5, 0, 0));
  packet.user.p_W = Vec3::Constant(1e308);  // finite, and sane by the checks on one packet
  packet.user.v_W = Vec3::Constant(-1e308);
  packet.object_count = 1;
  packet.objects[0].state.p_W = Vec3::Constant(1e308);
  packet.objects[0].state.v_W = Vec3::Constant(1e308);
  rig.put(packet);
  std::uint32_t status = kTickOk;
  for (int i = 0; i < 20; ++i) status = rig.tick();
  EXPECT_TRUE(status & kStateNotFinite);
  EXPECT_EQ(rig.device.force_W, Vec3::Zero());
}

// The program's run.

TEST(VirtualRun, RefusesToGoOnWithoutABody) {
  using demos::loadScenario;
  for (const char* file : {"experiment1.toml", "experiment2.toml"}) {
    demos::VirtualRun run(loadScenario(test::inCheckout("demos/scenarios/") + file, {}));
    run.world(1).world().removeRigidBody(run.world(1).site().proxyBody(0));
    try {
      run.run();
      ADD_FAILURE() << "went on";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("site 2: a body was taken out"), std::string::npos)
          << error.what();
    }
  }
}

TEST(VirtualRun, RefusesToGoOnWithoutTheObject) {
  demos::VirtualRun run(
      demos::loadScenario(test::inCheckout("demos/scenarios/experiment1.toml"), {}));
  run.world(0).world().removeRigidBody(&run.world(0).site().objectBody(0));
  EXPECT_THROW(run.run(), Error);
}

}  // namespace
}  // namespace tandem
