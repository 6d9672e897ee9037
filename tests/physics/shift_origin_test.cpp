// A host moves its whole world, as those do that keep their numbers small. Nobody feels it.

#include <cmath>
#include <limits>

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

constexpr double kHalf = 0.02;  // of the cubes [m]

/// Two hosts with a cube and a neighbour each, on a floor. A hand presses one cube against the
/// other; the peer's hand presses from above.
class PressedCubes {
 public:
  static constexpr double kRate = 60.0, kDelay = 0.03;

  explicit PressedCubes(Injection injection = Injection::kHandoff) : injection_(injection) {
    for (int i = 0; i < 2; ++i) {
      World& world = worlds_[i];
      world.rig.addBody(world.rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0,
                        Vec3(0.0, 0.0, -1.0));
      world.cube = &world.rig.addCube(0.2, kHalf, Vec3(0.0, 0.0, kHalf));
      world.neighbour = &world.rig.addCube(0.3, kHalf, Vec3(2.02 * kHalf, 0.0, kHalf));
      world.device.sample.hip.p_W = hand(i, 0.0);
      SiteSettings settings;
      settings.self = PeerId{static_cast<std::uint32_t>(i) + 1};
      settings.coordination = {50.0, 3.0};
      settings.host_step = 1.0 / rate();
      settings.injection = injection;
      world.site = std::make_unique<Site>(settings, world.rig.world, world.device);
      world.site->share(*world.cube);
      world.site->connect(PeerId{static_cast<std::uint32_t>(2 - i)}, links_[i], hand(1 - i, 0.0));
    }
  }
  ~PressedCubes() {
    for (World& world : worlds_) world.site.reset();
  }

  [[nodiscard]] double rate() const { return injection_ == Injection::kImpulse ? 1000.0 : kRate; }
  [[nodiscard]] Site& site(int i) { return *worlds_[i].site; }

  void step() {
    const double time = ++steps_ / rate();
    for (int i = 0; i < 2; ++i) {
      worlds_[i].device.sample.hip.p_W = hand(i, time);
      worlds_[i].rig.step(1.0 / rate());
      for (const StatePacket& packet : links_[i].sent)
        links_[1 - i].arrivals.push_back({packet, packet.time + kDelay});
      links_[i].sent.clear();
    }
  }

  /// Moves the first host's world.
  void shift(const Vec3& offset_W) {
    World& world = worlds_[0];
    for (const auto& body : world.rig.bodies) {
      btTransform pose = body->getWorldTransform();
      pose.getOrigin() += toBullet(offset_W);
      body->setWorldTransform(pose);
      body->setInterpolationWorldTransform(pose);
    }
    world.site->shiftOrigin(offset_W);
    shift_W += offset_W;
  }

  /// Position of the first host's cube (0) or neighbour (1), without the shift.
  [[nodiscard]] Vec3 place(int which) {
    const World& world = worlds_[0];
    return fromBullet((which == 0 ? world.cube : world.neighbour)->getCenterOfMassPosition()) -
           shift_W;
  }

  Vec3 shift_W = Vec3::Zero();

 private:
  struct World {
    BulletRig rig{Vec3(0.0, 0.0, -9.81)};
    FakeDevice device;
    btRigidBody *cube = nullptr, *neighbour = nullptr;
    std::unique_ptr<Site> site;
  };

  static Vec3 hand(int i, double time) {
    if (i == 1) return {0.002, 0.0, 2 * kHalf + 0.0095};
    return {-kHalf - 0.0095 + 0.001 * std::sin(4.0 * time), 0.001, kHalf};
  }

  Injection injection_;
  World worlds_[2];
  FakeLink links_[2] = {FakeLink(256), FakeLink(256)};
  int steps_ = 0;
};

/// Largest difference of force [N] and place [m] that shifts of this size [m] make.
struct Difference {
  double force = 0.0, place = 0.0, peer_force = 0.0;
  std::uint64_t peer_jumps = 0;
};

Difference compare(Injection injection, double size) {
  PressedCubes shifted(injection), still(injection);
  const auto period = static_cast<int>(shifted.rate() / 2);  // host steps between shifts
  Difference most;
  for (int step = 0; step < 4 * period; ++step) {
    if (step % period == period / 2)
      shifted.shift(size * (step / period % 2 == 0 ? 1.0 : -1.0) * Vec3(1.0, -0.5, 0.25));
    shifted.step();
    still.step();
    for (int which = 0; which < 2; ++which)
      most.place = std::max(most.place, (shifted.place(which) - still.place(which)).norm());
    most.force = std::max(most.force, (shifted.site(0).force() - still.site(0).force()).norm());
    most.peer_force =
        std::max(most.peer_force, (shifted.site(1).force() - still.site(1).force()).norm());
  }
  most.peer_jumps = shifted.site(1).counters().peer_jumps;
  EXPECT_GT(still.site(0).force().norm(), 0.2) << "the hand must press";
  EXPECT_GT(still.site(1).force().norm(), 0.2) << "the peer's hand must press";
  EXPECT_EQ(shifted.site(0).status(), kTickOk);
  return most;
}

// A float Bullet has places of 6e-5 m at 1 km, and of 1e-7 at 1 m.
TEST(ShiftOrigin, IsNotFeltDuringAPress) {
  const Difference most = compare(Injection::kHandoff, byWidth(1000.0, 1.0));
  EXPECT_LT(most.place, byWidth(1e-9, 1e-5));
  EXPECT_LT(most.force, byWidth(1e-5, 0.05));
  EXPECT_LT(most.peer_force, byWidth(1e-5, 0.05));
  EXPECT_EQ(most.peer_jumps, 0u);
}

// Bullet holds the cube on the floor, and rounding decides when its contact sticks.
TEST(ShiftOrigin, IsHardlyFeltWhereBulletMovesTheBodies) {
  const Difference most = compare(Injection::kImpulse, byWidth(1000.0, 1.0));
  EXPECT_LT(most.place, 5e-4);
  EXPECT_LT(most.force, 0.3);
  EXPECT_LT(most.peer_force, 0.3);
  EXPECT_EQ(most.peer_jumps, 0u);
}

TEST(ShiftOrigin, MovesTheHandTheProxiesAndWhatIsKnownOfPeers) {
  PressedCubes cubes;
  for (int step = 0; step < 30; ++step) cubes.step();
  Site& site = cubes.site(0);
  const Vec3 hip_W = site.hip().p_W, proxy_W = site.proxy(0)->p_W, told_W = site.latest(0).user.p_W;
  const Vec3 shown_W = fromBullet(site.proxyBody(0)->getCenterOfMassPosition());
  const Vec3 offset_W(100.0, 20.0, -3.0);
  cubes.shift(offset_W);
  EXPECT_LT((site.hip().p_W - hip_W - offset_W).norm(), 1e-12);
  EXPECT_LT((site.proxy(0)->p_W - proxy_W - offset_W).norm(), 1e-12);
  EXPECT_LT((site.latest(0).user.p_W - told_W - offset_W).norm(), 1e-12);
  EXPECT_LT((fromBullet(site.proxyBody(0)->getCenterOfMassPosition()) - shown_W - offset_W).norm(),
            byWidth(1e-12, 1e-5));
  cubes.step();
  EXPECT_LT((site.hip().p_W - hip_W - offset_W).norm(), 1e-3) << "the device goes along";
}

TEST(ShiftOrigin, OfAWorldAtRestLeavesItAtRest) {
  BulletRig rig(Vec3(0.0, 0.0, -9.81));
  rig.addBody(rig.makeShape<btBoxShape>(btVector3(1, 1, 1)), 0.0, Vec3(0.0, 0.0, -1.0));
  btRigidBody& cube = rig.addCube(0.2, kHalf, Vec3(0.0, 0.0, kHalf));
  FakeDevice device(Vec3(0.0, 0.0, 0.5));
  Site site({}, rig.world, device);
  site.share(cube);
  for (int step = 0; step < 60; ++step) rig.step(1.0 / 60.0);
  ASSERT_FALSE(cube.isActive()) << "it must be parked";
  const Vec3 offset_W(8.0, 4.0, 2.0);
  for (const auto& body : rig.bodies) {
    body->getWorldTransform().getOrigin() += toBullet(offset_W);
    body->setInterpolationWorldTransform(body->getWorldTransform());
  }
  site.shiftOrigin(offset_W);
  for (int step = 0; step < 60; ++step) {
    rig.step(1.0 / 60.0);
    EXPECT_NEAR((fromBullet(cube.getCenterOfMassPosition()) - offset_W).z(), kHalf,
                byWidth(1e-9, 1e-6));
  }
  EXPECT_FALSE(cube.isActive());
}

TEST(ShiftOrigin, ThatCannotBeIsRefused) {
  BulletRig rig;
  FakeDevice device;
  {
    Site site({}, rig.world, device);
    EXPECT_THROW(site.shiftOrigin(Vec3(std::numeric_limits<double>::infinity(), 0, 0)),
                 std::invalid_argument);
  }
  SiteSettings native;
  native.contact_model = ContactModel::kNativeRigid;
  Site site(native, rig.world, device);
  EXPECT_THROW(site.shiftOrigin(Vec3(1, 0, 0)), Error);
}

}  // namespace
}  // namespace tandem
