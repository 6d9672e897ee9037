// A remote peer that falls silent, seen at one site: behaviour of its proxy and its object copies.

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tandem/coordination/island_counters.h"
#include "tandem/coordination/scheme.h"
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

constexpr double kPeriod = 1e-3, kHostStep = 4e-3;
constexpr int kTicksPerStep = 4;
constexpr double kHalf = 0.02, kRadius = 0.01, kMass = 0.1;
constexpr double kPacket = 1.0 / 128.0;
constexpr PeerId kRemote{2};
const Vec3 kAway(-0.3, 0, 0.1);  // device away from the cube
const Vec3 kUser(0.3, 0, 0.1);   // remote user away from the cube

/// A cube on a floor, a device away from it and a remote user who sends while `is_heard`.
struct Rig {
  explicit Rig(SiteSettings settings = {}, const Vec3& gravity = Vec3(0, 0, -9.81))
      : host(gravity), cube(host.addCube(2 * kMass, kHalf, Vec3(0, 0, kHalf))) {
    if (gravity != Vec3::Zero())
      host.addBody(host.makeShape<btStaticPlaneShape>(btVector3(0, 0, 1), btScalar(0)), 0);
    settings.tick_source = TickSource::kCaller;
    settings.host_step = kHostStep;
    site = std::make_unique<Site>(settings, host.world, device);
    site->share(cube);
    site->connect(kRemote, link, kUser);
    packet = makePacket(kRemote, 0, kUser);
    packet.object_count = 1;
    packet.objects[0].state = site->object(0);
  }
  ~Rig() { site.reset(); }

  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kPeriod) {
      const double now = static_cast<double>(ticks) * kPeriod;
      if (is_heard && now >= next_packet - 1e-9) {
        link.arrivals.push_back({packet, now});
        ++packet.sequence;
        next_packet = now + packet_period;
      }
      EXPECT_EQ(site->tick(now) & ~allowed, kTickOk);
      if (++ticks % kTicksPerStep == 0) host.step(kHostStep);
    }
  }
  void lose() {
    is_heard = false;
    run(0.3 * std::max(1.0, packet_period / kPacket));
    ASSERT_EQ(state(), LinkState::kLost);
  }
  void hearAgain() { is_heard = true, next_packet = 0.0; }
  void moveUser(const Vec3& p_W) { packet.user.p_W = p_W; }
  [[nodiscard]] LinkState state() const { return site->linkState(0); }
  [[nodiscard]] const RigidState& proxy() const { return *site->proxy(0); }
  [[nodiscard]] bool isGhostInBullet() const { return !site->proxyBody(0)->hasContactResponse(); }

  BulletRig host;
  FakeDevice device{kAway};
  FakeLink link{100'000};
  btRigidBody& cube;
  std::unique_ptr<Site> site;
  StatePacket packet;
  double packet_period = kPacket, next_packet = 0.0;
  bool is_heard = true;
  std::uint32_t allowed = kTickOk;  ///< status bits that may come
  std::uint64_t ticks = 0;
};

SiteSettings ofScheme(const char* name) {
  SiteSettings settings;
  settings.scheme = &findScheme(name);
  return settings;
}

TEST(LinkLoss, GoesThroughAllStates) {
  Rig rig;
  rig.run(0.2);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  rig.is_heard = false;
  rig.run(0.05);
  EXPECT_EQ(rig.state(), LinkState::kStale);
  rig.run(0.1);
  EXPECT_EQ(rig.state(), LinkState::kFading);
  EXPECT_FALSE(rig.isGhostInBullet());
  rig.run(0.15);
  EXPECT_EQ(rig.state(), LinkState::kLost);
  EXPECT_TRUE(rig.isGhostInBullet());
  rig.hearAgain();
  rig.run(0.1);
  EXPECT_EQ(rig.state(), LinkState::kRejoining);
  EXPECT_FALSE(rig.isGhostInBullet());
  rig.run(0.5);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  EXPECT_EQ(rig.site->counters().links_faded, 1u);
  EXPECT_EQ(rig.site->counters().links_lost, 1u);
  EXPECT_EQ(rig.site->counters().links_rejoined, 1u);
}

TEST(LinkLoss, StaleProxySlowsDownAndLostOneStands) {
  Rig rig;
  rig.packet.user.v_W = Vec3(0, 0.1, 0);
  rig.run(0.2);
  EXPECT_GT(rig.proxy().v_W.norm(), 0.01);
  rig.is_heard = false;
  rig.run(0.24);
  EXPECT_LT(rig.proxy().v_W.norm(), 2e-3);
  rig.run(0.03);
  EXPECT_EQ(rig.proxy().v_W, Vec3(0, 0, 0));
  const Vec3 p_W = rig.proxy().p_W;
  rig.run(1.0);
  EXPECT_EQ(rig.proxy().p_W, p_W);

  Rig held(ofScheme("kinematic_proxy"));
  held.packet.user.v_W = Vec3(0, 0.1, 0);
  held.run(0.2);
  held.is_heard = false;
  held.run(0.065);
  const double age_over = 0.065 - kPacket - 0.025;
  EXPECT_NEAR(held.proxy().v_W.y(), 0.1 * std::exp(-age_over / 0.02), 0.1 * 0.35);
  EXPECT_LT(held.proxy().v_W.y(), 0.05);
  held.run(0.25);
  EXPECT_EQ(held.proxy().v_W, Vec3(0, 0, 0));
}

TEST(LinkLoss, LostProxyIsPassedByTheDevice) {
  for (const char* scheme : {"kinematic_proxy", "remote_dynamic_proxy"}) {
    Rig rig(ofScheme(scheme));
    rig.run(0.1);
    rig.lose();
    rig.device.sample.hip.p_W = kUser + Vec3(0.005, 0, 0);
    rig.run(0.2);
    EXPECT_EQ(rig.site->force(), Vec3(0, 0, 0)) << scheme;
    // The user is heard again at the device's place, and the proxy stays out.
    rig.hearAgain();
    rig.run(1.0);
    EXPECT_EQ(rig.state(), LinkState::kRejoining) << scheme;
    EXPECT_EQ(rig.site->force(), Vec3(0, 0, 0)) << scheme;
    // The ghost follows the user meanwhile.
    rig.moveUser(kUser + Vec3(0, 0, 0.004));
    rig.run(0.05);
    EXPECT_EQ(rig.proxy().p_W, rig.packet.user.p_W) << scheme;
    rig.device.sample.hip.p_W = kAway;
    rig.run(0.6);
    EXPECT_EQ(rig.state(), LinkState::kLive) << scheme;
    rig.device.sample.hip.p_W = rig.packet.user.p_W + Vec3(2 * kRadius - 1e-3, 0, 0);
    rig.run(kPeriod);
    EXPECT_GT(rig.site->force().x(), 1.0) << scheme;
  }
}

TEST(LinkLoss, IsNotLetInInsideObjectsAndObstacles) {
  Rig rig;
  rig.run(0.1);
  rig.lose();
  for (const Vec3& taken : {Vec3(0, 0, 0.045), Vec3(0.2, 0, 0.005)}) {  // in the cube, in the floor
    rig.moveUser(taken);
    rig.hearAgain();
    rig.run(0.3);
    EXPECT_EQ(rig.state(), LinkState::kRejoining);
    EXPECT_TRUE(rig.isGhostInBullet());
    EXPECT_EQ(rig.proxy().p_W, taken);
    EXPECT_NEAR(rig.site->object(0).p_W.z(), kHalf, 1e-5);
  }
  rig.moveUser(Vec3(0.2, 0, 0.05));
  rig.run(0.6);
  EXPECT_EQ(rig.state(), LinkState::kLive);
}

TEST(LinkLoss, IsNotLetInInsideABodyOfTheHost) {
  Rig rig({}, Vec3::Zero());
  btRigidBody& other = rig.host.addCube(0.5, kHalf, Vec3(0.5, 0, kHalf));
  rig.run(0.1);
  rig.lose();
  rig.moveUser(Vec3(0.52, 0, kHalf));
  rig.hearAgain();
  rig.run(0.3);
  EXPECT_EQ(rig.state(), LinkState::kRejoining);
  EXPECT_TRUE(rig.isGhostInBullet());
  rig.run(0.3);
  EXPECT_LT((fromBullet(other.getCenterOfMassPosition()) - Vec3(0.5, 0, kHalf)).norm(),
            byWidth(1e-9, 1e-6));
}

TEST(LinkLoss, ProxyComesBackWithoutEnergy) {
  for (const bool is_guided : {true, false}) {
    SiteSettings settings;
    if (is_guided) settings.guide = Vec3(1, 0, 0);
    Rig rig(settings, Vec3::Zero());
    rig.run(0.1);
    rig.lose();
    rig.moveUser(kUser + Vec3(0.15, 0, 0));
    rig.hearAgain();
    for (int i = 0; i < 800; ++i) {
      rig.run(kPeriod);
      const double way = rig.proxy().p_W.x() - rig.packet.user.p_W.x();
      const double energy = 0.5 * kMass * rig.proxy().v_W.squaredNorm() + 0.5 * 200.0 * way * way;
      ASSERT_LT(energy, 1e-20) << i;
    }
    EXPECT_EQ(rig.state(), LinkState::kLive);
  }
}

// A spring that regains its gain while stretched would put 0.25 J into the copy.
TEST(LinkLoss, ObjectComesBackAtAWalkingPace) {
  Rig rig({}, Vec3::Zero());
  rig.run(0.1);
  rig.lose();
  constexpr double kGap = 0.05, kPace = 0.25;
  rig.packet.objects[0].state.p_W.y() += kGap;
  rig.hearAgain();
  double fastest = 0.0;
  for (int i = 0; i < 1200; ++i) {
    rig.run(kPeriod);
    fastest = std::max(fastest, rig.site->object(0).v_W.norm());
  }
  EXPECT_GT(fastest, 0.3 * kPace);
  EXPECT_LT(fastest, 1.3 * kPace);
  EXPECT_LT((rig.packet.objects[0].state.p_W - rig.site->object(0).p_W).norm(), 1e-4);
  EXPECT_EQ(rig.state(), LinkState::kLive);
}

TEST(LinkLoss, FadingWakesAndLosingLetsSleep) {
  Rig rig;
  rig.run(1.0);
  ASSERT_GT(rig.site->islandCounters().asleep, 100u);
  rig.is_heard = false;
  rig.run(0.08);
  const std::uint64_t before = rig.site->islandCounters().asleep;
  rig.run(0.08);
  EXPECT_LT(rig.site->islandCounters().asleep - before, 60u);  // fading wakes it at 100 ms
  rig.run(0.5);
  EXPECT_EQ(rig.state(), LinkState::kLost);
  const std::uint64_t skipped = rig.site->counters().host_steps_skipped;
  rig.run(0.4);
  EXPECT_EQ(rig.site->counters().host_steps_skipped, skipped + 100);
}

TEST(LinkLoss, IdleSendersAreWaitedForLonger) {
  Rig rig;
  rig.packet.is_idle = true;
  rig.packet_period = kIdlePacketPeriod;
  rig.run(1.0);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  rig.is_heard = false;
  rig.run(0.18 - kIdlePacketPeriod);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  rig.run(1.5);
  EXPECT_EQ(rig.state(), LinkState::kFading);
  rig.run(0.4);
  EXPECT_EQ(rig.state(), LinkState::kLost);
}

TEST(LinkLoss, WaitsForTheFirstPacketIfToldTo) {
  SiteSettings settings;
  settings.link_loss.start_live = false;
  Rig rig(settings);
  rig.is_heard = false;
  rig.device.sample.hip.p_W = kUser + Vec3(0.005, 0, 0);
  rig.run(0.5);
  EXPECT_EQ(rig.state(), LinkState::kWaiting);
  EXPECT_TRUE(rig.isGhostInBullet());
  EXPECT_EQ(rig.site->force(), Vec3(0, 0, 0));
  rig.device.sample.hip.p_W = kAway;
  rig.run(0.1);
  rig.hearAgain();
  rig.run(0.1);
  EXPECT_EQ(rig.state(), LinkState::kRejoining);
  rig.run(0.5);
  EXPECT_EQ(rig.state(), LinkState::kLive);
}

TEST(LinkLoss, OffPullsForEver) {
  SiteSettings settings;
  settings.link_loss.enabled = false;
  Rig rig(settings);
  rig.run(0.1);
  rig.is_heard = false;
  rig.run(5.0);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  EXPECT_FALSE(rig.isGhostInBullet());
  EXPECT_EQ(rig.site->counters().links_lost, 0u);
}

TEST(LinkLoss, ImpulseInjectionDoesTheSame) {
  SiteSettings settings;
  settings.injection = Injection::kImpulse;
  Rig rig(settings, Vec3::Zero());
  rig.is_heard = true;
  // The host steps together with the ticks.
  const auto run = [&](double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kPeriod) {
      const double now = static_cast<double>(rig.ticks++) * kPeriod;
      if (rig.is_heard && now >= rig.next_packet) {
        rig.link.arrivals.push_back({rig.packet, now});
        ++rig.packet.sequence;
        rig.next_packet = now + kPacket;
      }
      EXPECT_EQ(rig.site->tick(now), kTickOk);
      rig.host.step(kPeriod);
    }
  };
  run(0.2);
  rig.is_heard = false;
  run(0.5);
  EXPECT_EQ(rig.state(), LinkState::kLost);
  EXPECT_TRUE(rig.isGhostInBullet());
  rig.moveUser(kUser + Vec3(0, 0.1, 0));
  rig.is_heard = true;
  run(1.0);
  EXPECT_EQ(rig.state(), LinkState::kLive);
  EXPECT_LT(
      (fromBullet(rig.site->proxyBody(0)->getCenterOfMassPosition()) - rig.packet.user.p_W).norm(),
      byWidth(1e-9, 1e-5));
}

class NativeLinkLoss : public ::testing::TestWithParam<ContactModel> {};

TEST_P(NativeLinkLoss, FadesLosesAndComesBack) {
  for (const char* scheme : {"kinematic_proxy", "remote_dynamic_proxy"}) {
    SCOPED_TRACE(scheme);
    SiteSettings settings = ofScheme(scheme);
    settings.contact_model = GetParam();
    Rig rig(settings, Vec3::Zero());
    // Point-to-point joints throw the cube for a moment while their gains fall (docs/native.md).
    if (GetParam() == ContactModel::kPointToPoint) rig.allowed = kOutOfRange;
    rig.run(0.2);
    rig.packet.objects[0].state.p_W.y() = 0.01;
    rig.run(0.02);
    rig.is_heard = false;
    rig.run(0.3);
    EXPECT_EQ(rig.state(), LinkState::kLost);
    EXPECT_TRUE(rig.isGhostInBullet());
    // Nothing pulls at the cube any more.
    rig.cube.setLinearVelocity(btVector3(0, 0, btScalar(0.1)));
    rig.run(0.2);
    EXPECT_NEAR(rig.site->object(0).v_W.z(), 0.1, 1e-4);
    rig.cube.setLinearVelocity(btVector3(0, 0, 0));
    // Inside the cube the proxy stays out; beside it the proxy returns.
    const Vec3 beside = rig.site->object(0).p_W + Vec3(0.2, 0, 0);
    rig.moveUser(rig.site->object(0).p_W + Vec3(kHalf, 0, 0));
    rig.packet.objects[0].state.p_W = rig.site->object(0).p_W;
    rig.hearAgain();
    rig.run(0.2);
    EXPECT_EQ(rig.state(), LinkState::kRejoining);
    EXPECT_TRUE(rig.isGhostInBullet());
    rig.moveUser(beside);
    rig.run(0.8);
    EXPECT_EQ(rig.state(), LinkState::kLive);
    EXPECT_LT((rig.proxy().p_W - beside).norm(), 1e-3);
    EXPECT_TRUE(isFinite(rig.site->object(0)));
  }
}

/// On a float Bullet, point-to-point joints blow up while their gains fall (docs/native.md).
std::vector<ContactModel> modelsThatCanFade() {
  std::vector<ContactModel> models = {ContactModel::kNativeRigid, ContactModel::kNativeSoft,
                                      ContactModel::kSpring6Dof};
  if (sizeof(btScalar) == 8) models.push_back(ContactModel::kPointToPoint);
  return models;
}
INSTANTIATE_TEST_SUITE_P(Models, NativeLinkLoss, ::testing::ValuesIn(modelsThatCanFade()));

}  // namespace
}  // namespace tandem
