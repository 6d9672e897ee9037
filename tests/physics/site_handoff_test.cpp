// A site in a host's world: the states that reach Bullet, and the host's actions that reach the
// hand.

#include <cmath>

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

constexpr PeerId kRemote{2};
const Vec3 kFarAway(10.0, 0.0, 0.0);

// m x'' + B x' + K x = 0 from x0 at rest. K = 2000, B = 10, m = 0.1: w0 = 141/s, damping ratio
// 0.35.
double computeRinging(double x0, double t) {
  const double c = 10.0 / 0.2, w = std::sqrt(2000.0 / 0.1 - c * c);
  return x0 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
}

/// A proxy with its coupler only. It starts 10 mm from its user, who is at rest and sent one
/// packet.
struct LoneProxy {
  BulletRig rig;
  FakeDevice device{kFarAway};
  FakeLink link;
  std::unique_ptr<Site> site;

  explicit LoneProxy(SiteSettings settings = {}) {
    settings.coordination = {2000.0, 10.0};
    settings.link_loss.enabled = false;  // one packet pulls for ever
    site = std::make_unique<Site>(settings, rig.world, device);
    site->connect(kRemote, link, Vec3(0.01, 0.0, 0.0));
    link.arrivals.push_back({makePacket(kRemote, 0, Vec3::Zero()), 0.0});
  }
  [[nodiscard]] double bodyX() const {
    return site->proxyBody(0)->getWorldTransform().getOrigin().x();
  }
};

class LoneCouplerAfterHandoff : public ::testing::TestWithParam<double> {};

// The btRigidBody itself is on the closed form after every host step, at any step size.
TEST_P(LoneCouplerAfterHandoff, BodyFollowsTheClosedForm) {
  LoneProxy proxy;
  double worst = 0.0, t = 0.0;
  for (int step = 0; t < 0.5; ++step) {
    proxy.rig.step(1.0 / GetParam());
    t += static_cast<btScalar>(1.0 / GetParam());
    worst = std::max(worst, std::abs(proxy.bodyX() - computeRinging(0.01, t)));
  }
  // Float: half a bit of 10 mm. Double: the requested tolerance.
  EXPECT_LT(worst, byWidth(1e-9, 1e-9 + 0.01 * 0x1p-24));
}

// At 4000 Hz the host is faster than the island's ticks.
INSTANTIATE_TEST_SUITE_P(HostRates, LoneCouplerAfterHandoff,
                         ::testing::Values(60.0, 240.0, 1000.0, 4000.0));

TEST(LoneCoupler, BodyFollowsTheClosedFormAtAChangingStep) {
  LoneProxy proxy;
  double worst = 0.0, t = 0.0;
  for (int step = 0; t < 0.5; ++step) {
    const auto dt = static_cast<btScalar>(0.003 + 0.002 * ((step * 7) % 5));
    proxy.rig.step(dt);
    t += dt;
    worst = std::max(worst, std::abs(proxy.bodyX() - computeRinging(0.01, t)));
  }
  // Between announced moments the pose is cubic in the tick: w^4 h^4 / 384 of 10 mm is 1e-8 m.
  EXPECT_LT(worst, byWidth(1e-8, 2e-8));
}

class Grouping : public ::testing::TestWithParam<int> {};

TEST_P(Grouping, SubStepsPerCallDoNotChangeTheIsland) {
  const auto run = [](int per_call) {
    LoneProxy proxy;
    const auto dt = static_cast<btScalar>(1.0 / 240.0);
    for (int done = 0; done < 64; done += per_call)
      proxy.rig.world.stepSimulation(static_cast<btScalar>(per_call) * dt, per_call, dt);
    return proxy.site->stateHash();
  };
  EXPECT_EQ(run(GetParam()), run(1));
}
INSTANTIATE_TEST_SUITE_P(SubSteps, Grouping, ::testing::Values(1, 4, 16));

/// A shared cube whose face at -x just touches the local hand.
struct HeldCube {
  BulletRig rig;
  FakeDevice device{Vec3(-0.03, 0.0, 0.0)};
  FakeLink link;
  btRigidBody& cube;
  std::unique_ptr<Site> site;

  explicit HeldCube(double mass = 0.2, const Vec3& gravity = Vec3::Zero())
      : rig(gravity), cube(rig.addCube(mass)) {
    SiteSettings settings;
    settings.contact = {2000.0, 5.0};
    settings.coordination = {0.0, 0.0};
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(cube);
  }
};

TEST(SharedObject, CarriesItsShareOfTheMassUntilTheSiteEnds) {
  HeldCube held(0.2);
  EXPECT_NEAR(1.0 / held.cube.getInvMass(), 0.1, 1e-7);
  held.site.reset();
  EXPECT_NEAR(1.0 / held.cube.getInvMass(), 0.2, 1e-7);
}

// The host pushes with 4 N for 0.1 s. The copy of 0.1 kg receives the momentum of 0.4 N s exactly
// once.
TEST(HostsOwnForce, MovesTheIslandBody) {
  for (const double rate : {60.0, 240.0, 1000.0}) {
    HeldCube held;
    held.device.sample.hip.p_W = kFarAway;
    const int steps = static_cast<int>(0.1 * rate);
    for (int i = 0; i < steps; ++i) {
      held.cube.applyCentralForce(btVector3(0, 4, 0));
      held.rig.step(1.0 / rate);
    }
    for (int i = 0; i < 3; ++i) held.rig.step(1.0 / rate);  // an impulse given at the end arrives
    EXPECT_NEAR(held.cube.getLinearVelocity().y(), 4.0 * steps / rate / 0.1, byWidth(1e-9, 1e-5))
        << rate;
  }
}

TEST(HostsOwnImpulse, MovesTheIslandBody) {
  HeldCube held;
  held.device.sample.hip.p_W = kFarAway;
  held.rig.step(1.0 / 240.0);
  held.cube.applyCentralImpulse(btVector3(0, btScalar(0.02), 0));
  for (int i = 0; i < 4; ++i) held.rig.step(1.0 / 240.0);
  EXPECT_NEAR(held.site->object(0).v_W.y(), 0.2, byWidth(1e-9, 1e-6));
}

// The hand feels the same push towards it: the spring sinks by F / K.
TEST(HostsOwnForce, IsFeltAtTheDevice) {
  HeldCube held;
  double force = 0.0;
  for (int i = 0; i < 480; ++i) {
    held.cube.applyCentralForce(btVector3(-3, 0, 0));
    held.rig.step(1.0 / 240.0);
    force = held.device.force_W.x();
  }
  EXPECT_NEAR(force, -3.0, 0.02);
}

TEST(HostsTeleport, TakesTheIslandBodyAlong) {
  HeldCube held;
  held.device.sample.hip.p_W = kFarAway;
  held.rig.step(1.0 / 240.0);
  btTransform pose = held.cube.getWorldTransform();
  pose.setOrigin(btVector3(0, btScalar(0.5), 0));
  held.cube.setWorldTransform(pose);
  held.rig.step(1.0 / 240.0);
  EXPECT_NEAR(held.site->object(0).p_W.y(), 0.5, byWidth(1e-12, 1e-6));
  EXPECT_NEAR(held.cube.getWorldTransform().getOrigin().y(), 0.5, byWidth(1e-12, 1e-6));
}

TEST(SharedObject, FallsAsTheClosedFormSays) {
  HeldCube held(0.2, Vec3(0.0, -9.81, 0.0));
  held.device.sample.hip.p_W = kFarAway;
  for (int i = 0; i < 60; ++i) held.rig.step(1.0 / 60.0);
  const double t = 60.0 * static_cast<btScalar>(1.0 / 60.0);
  EXPECT_NEAR(held.cube.getWorldTransform().getOrigin().y(), -0.5 * 9.81 * t * t,
              byWidth(1e-8, 2e-6));
}

// Below mu m g friction holds a cube on a floor against a finger; above, it slides by Coulomb's
// law.
TEST(SharedObject, SticksAndSlidesOnAFloor) {
  for (const double force : {0.4, 0.9}) {
    BulletRig rig(Vec3(0.0, 0.0, -9.81));
    btRigidBody& floor = rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.05))),
                                     0.0, Vec3(0.0, 0.0, -0.07));
    btRigidBody& cube = rig.addCube(0.2);
    floor.setFriction(btScalar(0.5));
    cube.setFriction(btScalar(1.0));
    FakeDevice device(kFarAway);
    SiteSettings settings;
    settings.coordination = {0.0, 0.0};
    Site site(settings, rig.world, device);
    site.share(cube);
    for (int i = 0; i < 60; ++i) rig.step(1.0 / 60.0);  // settle
    const Vec3 rest = site.object(0).p_W;
    EXPECT_NEAR(rest.z(), 0.0, 5e-5);
    EXPECT_NEAR(rest.head<2>().norm(), 0.0, 1e-5);
    for (int i = 0; i < 30; ++i) {
      cube.applyCentralForce(btVector3(static_cast<btScalar>(force), 0, 0));
      rig.step(1.0 / 60.0);
    }
    // A copy of 0.1 kg holds up to 0.5 * 0.1 * 9.81 = 0.49 N. Half a second above that gives (F -
    // 0.49) / m t.
    const double speed = force < 0.4905 ? 0.0 : (force - 0.4905) / 0.1 * 0.5;
    EXPECT_NEAR(site.object(0).v_W.x(), speed, 0.04 * speed + 1e-3) << force;
  }
}

// A moving body that is not shared is Bullet's. Momentum is handed over and back, and none is lost.
TEST(NativeNeighbour, KeepsMomentumWithTheSharedCube) {
  BulletRig rig;
  btRigidBody& cube = rig.addCube(0.2);
  btRigidBody& box = rig.addCube(0.2, 0.02, Vec3(0.06, 0.0, 0.0));
  FakeDevice device(kFarAway);
  SiteSettings settings;
  settings.coordination = {0.0, 0.0};
  Site site(settings, rig.world, device);
  site.share(cube);
  cube.setLinearVelocity(btVector3(btScalar(0.4), 0, 0));
  for (int i = 0; i < 120; ++i) rig.step(1.0 / 240.0);
  EXPECT_GT(box.getLinearVelocity().x(), 0.1);
  EXPECT_NEAR(0.1 * site.object(0).v_W.x() + 0.2 * box.getLinearVelocity().x(), 0.1 * 0.4,
              byWidth(1e-9, 1e-6));
}

TEST(Site, SecondSiteOnAWorldIsRefused) {
  BulletRig rig;
  FakeDevice device;
  Site first({}, rig.world, device);
  EXPECT_THROW(Site({}, rig.world, device), Error);
}

// A hand wrongly placed at the world's origin would push bodies there.
TEST(Site, DeviceWithoutAPositionIsRefused) {
  BulletRig rig;
  FakeDevice device;
  device.sample.valid = false;
  EXPECT_THROW(Site({}, rig.world, device), Error);
  device.sample = {{Vec3(std::nan(""), 0.0, 0.0), Vec3::Zero()}, true};
  EXPECT_THROW(Site({}, rig.world, device), Error);
}

TEST(Site, GivesTheWorldBackAsItWas) {
  BulletRig rig(Vec3(0.0, -9.81, 0.0));
  btRigidBody& cube = rig.addCube(0.2);
  const int bodies = rig.world.getNumCollisionObjects();
  const btScalar damping = cube.getLinearDamping();
  const int activation = cube.getActivationState();
  {
    FakeDevice device(kFarAway);
    FakeLink link;
    Site site({}, rig.world, device);
    site.share(cube);
    site.connect(kRemote, link, Vec3(0.1, 0.0, 0.0));
    EXPECT_EQ(rig.world.getNumCollisionObjects(), bodies + 1);
    for (int i = 0; i < 10; ++i) rig.step(1.0 / 240.0);
  }
  EXPECT_EQ(rig.world.getNumCollisionObjects(), bodies);
  EXPECT_EQ(cube.getLinearDamping(), damping);
  EXPECT_EQ(cube.getActivationState(), activation);
  rig.step(1.0 / 240.0);  // no callback is called any more
}

TEST(Site, RefusesWhatCannotWork) {
  BulletRig rig;
  FakeDevice device;
  SiteSettings settings;
  settings.haptic_rate = 0.0;
  EXPECT_THROW(Site(settings, rig.world, device), std::invalid_argument);
  settings = {};
  settings.packet_rate = 2000.0;
  EXPECT_THROW(Site(settings, rig.world, device), std::invalid_argument);
  settings = {};
  settings.injection = Injection::kImpulse;
  settings.contact = {1e6, 0.0};
  Site stiff(settings, rig.world, device);
  try {
    stiff.share(rig.addCube(0.2));
    FAIL() << "an unstable injection was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("use hand-off"), std::string::npos) << error.what();
  }
  EXPECT_THROW(stiff.share(rig.addCube(0.0)), Error);
  BulletRig other;
  const BulletAbi wrong_width{sizeof(btScalar) == 8 ? 4u : 8u, BT_BULLET_VERSION};
  EXPECT_THROW(Site({}, other.world, device, wrong_width), Error);
}

}  // namespace
}  // namespace tandem
