// Forces of a host that follow a shared body's motion: they feed it no more than in Bullet alone.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <tuple>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "bridge/bullet_rig.h"
#include "support/fakes.h"

namespace tandem {
namespace {

using test::BulletRig;
using test::byWidth;
using test::FakeDevice;

constexpr double kMass = 0.2;         // [kg]
constexpr double kStiffness = 100.0;  // of the host's spring [N/m], 22 rad/s
constexpr double kStart = 0.1;        // [m]

/// A cube on a spring of its host's, with a site that shares it or without.
struct SprungCube {
  BulletRig rig;
  FakeDevice device{Vec3(10.0, 0.0, 0.0)};
  btRigidBody& cube;
  std::unique_ptr<Site> site;
  bool is_caller = false;
  int ticks = 0;
  double time = 0.0;

  explicit SprungCube(const Vec3& gravity = Vec3::Zero())
      : rig(gravity), cube(rig.addCube(kMass, 0.02, Vec3(kStart, 0.0, 0.0))) {
    cube.setActivationState(DISABLE_DEACTIVATION);
  }
  void share(TickSource source, double rate) {
    is_caller = source == TickSource::kCaller;
    SiteSettings settings;
    settings.peers = 1;
    settings.tick_source = source;
    settings.host_step = 1.0 / rate;
    site = std::make_unique<Site>(settings, rig.world, device);
    site->share(cube);
  }
  [[nodiscard]] Vec3 place() const { return fromBullet(cube.getWorldTransform().getOrigin()); }
  void pull() { cube.applyCentralForce(toBullet(Vec3(-kStiffness * place()))); }
  /// As far as it gets from now on [m].
  double swing(double duration, double rate, bool in_callback) {
    double farthest = 0.0;
    const int steps = static_cast<int>(duration * rate + 0.5);
    for (int i = 0; i < steps; ++i) {
      step(rate, [&] {
        if (!in_callback) pull();
      });
      farthest = std::max(farthest, place().norm());
    }
    return farthest;
  }
  template <typename Before>
  void step(double rate, Before before) {
    time += static_cast<btScalar>(1.0 / rate);
    if (is_caller)
      for (; ticks < time * 1000.0 - 1e-6; ++ticks) site->tick(ticks / 1000.0);
    before();
    rig.step(1.0 / rate);
  }
};

class SpringOfAHost : public ::testing::TestWithParam<std::tuple<double, bool>> {};
INSTANTIATE_TEST_SUITE_P(RatesAndCallbacks, SpringOfAHost,
                         ::testing::Combine(::testing::Values(60.0, 240.0), ::testing::Bool()));

void pullInTick(btDynamicsWorld* world, btScalar) {
  static_cast<SprungCube*>(world->getWorldUserInfo())->pull();
}

// The first force cannot be told from one that stays. It is spread over the host's step, or comes a
// step late if the caller ticks, and gives as much of the amplitude once.
TEST_P(SpringOfAHost, SwingsAsInBullet) {
  const auto [rate, in_callback] = GetParam();
  const double turn = std::sqrt(kStiffness / kMass) / rate;  // in a step [rad]
  for (const TickSource source : {TickSource::kHostStep, TickSource::kCaller}) {
    SprungCube bare, shared;
    for (SprungCube* host : {&bare, &shared})
      if (in_callback) host->rig.world.setInternalTickCallback(pullInTick, host, true);
    shared.share(source, rate);
    const double most = bare.swing(60.0, rate, in_callback);
    const double early = shared.swing(4.0, rate, in_callback);
    shared.swing(52.0, rate, in_callback);
    const double late = shared.swing(4.0, rate, in_callback);
    std::printf("%g Hz, source %d: bare %.4f m, shared %.4f m, after a minute %.4f m\n", rate,
                static_cast<int>(source), most, early, late);
    EXPECT_LT(early, (1.0 + (source == TickSource::kCaller ? turn : 0.5 * turn * turn)) * most);
    EXPECT_LT(late, 1.01 * early);
    EXPECT_GT(late, 0.9 * kStart);
  }
}

// A host's controller turns a body on a spring of torque.
TEST(SpringOfAHost, TurnsAsInBullet) {
  constexpr double kAngle = 0.5, kTurning = 400.0;  // [rad], pace squared [1/s^2]
  for (const double rate : {60.0, 240.0}) {
    SprungCube shared;
    shared.cube.setWorldTransform(toBullet(Vec3::Zero(), test::turn(kAngle, Vec3::UnitZ())));
    shared.share(TickSource::kHostStep, rate);
    const double inertia = static_cast<double>(shared.cube.getLocalInertia().z());
    double most = 0.0;
    for (int i = 0; i < static_cast<int>(30.0 * rate); ++i) {
      const Quat q = fromBullet(shared.cube.getWorldTransform().getRotation());
      const double angle = 2.0 * std::atan2(q.z(), q.w());
      shared.step(rate, [&] {
        shared.cube.applyTorque(toBullet(Vec3(0.0, 0.0, -kTurning * inertia * angle)));
      });
      if (i > 29.0 * rate) most = std::max(most, std::abs(angle));
    }
    EXPECT_LT(most, 1.15 * kAngle) << rate;
    EXPECT_GT(most, 0.9 * kAngle) << rate;
  }
}

// Below the limit of friction a force holds a body however it varies: kicks would let it creep.
TEST(ForceOfAHost, ThatVariesLetsNothingCreep) {
  for (const TickSource source : {TickSource::kHostStep, TickSource::kCaller}) {
    SprungCube host(Vec3(0.0, 0.0, -9.81));
    btRigidBody& floor = host.rig.addBody(
        host.rig.makeShape<btBoxShape>(btVector3(1, 1, btScalar(0.1))), 0.0, Vec3(0.0, 0.0, -0.12));
    floor.setFriction(btScalar(0.5));
    host.cube.setFriction(1);
    host.share(source, 60.0);
    for (int i = 0; i < 30; ++i) host.step(60.0, [] {});
    const Vec3 start = host.place();
    for (int i = 0; i < 120; ++i) {
      const double push = 0.4 + 0.3 * std::sin(0.2 * i);  // of 0.98 N
      host.step(60.0, [&] { host.cube.applyCentralForce(toBullet(Vec3(push, 0.0, -0.1 * push))); });
    }
    const Vec3 way = host.place() - start;
    std::printf("crept by %.2e m, sank by %.2e m\n", way.head<2>().norm(), -way.z());
    EXPECT_LT(way.norm(), 2e-5);
  }
}

}  // namespace
}  // namespace tandem
