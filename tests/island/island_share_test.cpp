// Shares of gains, ghosts and extra damping: closed forms, with and without the guide.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;
constexpr double kRadius = 0.01, kHalf = 0.02;
constexpr double kMass = 0.1;
const CouplerGains kContact{4000.0, 1.0}, kTie{200.0, 30.0};

/// A cube tied to its start, between a hand on the left and a proxy on the right, all just
/// touching.
struct Scene {
  explicit Scene(bool is_guided) : island(makeSettings(is_guided)) {
    IslandBody body;
    body.shape = Sphere{kRadius};
    body.motion = Motion::kPrescribed;
    body.feels_obstacles = true;
    body.start.p_W.x() = -kHalf - kRadius;
    hand = island.addBody(body);
    body.motion = Motion::kDynamic;
    body.mass = kMass;
    body.start.p_W.x() = kHalf + kRadius;
    proxy = island.addBody(body);
    IslandBody box;
    box.shape = Box{Vec3::Constant(kHalf)};
    box.mass = kMass;
    box.inertia_B = Vec3::Constant(kMass * 4.0 * kHalf * kHalf / 6.0);
    cube = island.addBody(box);
    proxy_tie = island.addCoupler(proxy, {kTie, {}});
    cube_tie = island.addCoupler(cube, {kTie, {0.02, 0.003}});
    island.addContact(hand, cube, kContact);
    island.addContact(proxy, cube, kContact);
    island.prepare();
  }
  static IslandSettings makeSettings(bool is_guided) {
    IslandSettings settings;
    settings.obstacle_contact = kContact;
    if (is_guided) settings.guide = Vec3(1, 0, 0);
    return settings;
  }
  void run(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += kPeriod) island.advance(kPeriod);
  }
  void move(BodyIndex body, const Vec3& way, const Vec3& v_W = Vec3::Zero()) {
    RigidState state = island.state(body);
    state.p_W += way;
    state.v_W = v_W;
    island.setState(body, state);
  }
  [[nodiscard]] double x(BodyIndex body) const { return island.state(body).p_W.x(); }

  Island island;
  BodyIndex hand, proxy, cube;
  CouplerIndex proxy_tie, cube_tie;
};

class IslandShare : public ::testing::TestWithParam<bool> {
 protected:
  Scene scene{GetParam()};
  Island& island = scene.island;
};

TEST_P(IslandShare, StaticPullIsInProportion) {
  // A force of 1 N acts against K_t, then against half of it.
  island.setGhost(scene.proxy, true);
  island.setExternalWrench(scene.cube, Vec3(1, 0, 0), Vec3::Zero());
  for (const double share : {1.0, 0.5, 0.25}) {
    island.setCouplerShare(scene.cube_tie, share);
    EXPECT_EQ(island.couplerShare(scene.cube_tie), share);
    scene.run(8.0);
    EXPECT_NEAR(scene.x(scene.cube), 1.0 / (200.0 * share), 1e-9) << share;
    EXPECT_NEAR(island.computeCouplerForce(scene.cube_tie).x(), -1.0, 1e-6);
  }
}

TEST_P(IslandShare, ContactPushIsInProportion) {
  scene.run(kPeriod);  // a hand that starts in the cube would be let in gently
  scene.move(scene.hand, Vec3(1e-3, 0, 0));
  EXPECT_NEAR(island.computeContactForce(scene.hand).x(), -4.0, 1e-12);
  island.setContactShare(scene.cube, 0.5);
  EXPECT_NEAR(island.computeContactForce(scene.hand).x(), -2.0, 1e-12);
  island.setContactShare(scene.hand, 0.25);
  EXPECT_NEAR(island.computeContactForce(scene.hand).x(), -0.5, 1e-12);
  EXPECT_NEAR(island.computeContactForce(scene.cube).x(), 0.5, 1e-12);
}

TEST_P(IslandShare, WithoutGainsABodyGoesOnAndExtraDampingStopsIt) {
  island.setCouplerShare(scene.proxy_tie, 0.0);
  scene.move(scene.proxy, Vec3::Zero(), Vec3(0.2, 0, 0));
  scene.run(0.1);
  EXPECT_NEAR(island.state(scene.proxy).v_W.x(), 0.2, 1e-12);
  island.setExtraDamping(scene.proxy, 2.0);  // 50 ms
  scene.run(0.05);
  EXPECT_NEAR(island.state(scene.proxy).v_W.x(), 0.2 * std::exp(-1.0), 1e-12);
  EXPECT_NEAR(scene.x(scene.proxy), kHalf + kRadius + 0.02 + 0.01 * (1.0 - std::exp(-1.0)), 1e-12);
}

// Exact maps of before do not fit another mass.
TEST_P(IslandShare, AnotherMassGoesOnAtTheSameVelocity) {
  island.setCouplerShare(scene.proxy_tie, 0.0);
  scene.move(scene.proxy, Vec3::Zero(), Vec3(0.2, 0, 0));
  scene.run(0.1);
  island.setMass(scene.proxy, 2.0 * kMass, Vec3::Zero(), 0.0);
  EXPECT_EQ(island.state(scene.proxy).v_W.x(), 0.2);
  island.setExternalWrench(scene.proxy, Vec3(0.4, 0, 0), Vec3::Zero());
  scene.run(0.05);
  EXPECT_NEAR(island.state(scene.proxy).v_W.x(), 0.2 + 0.05 * 0.4 / (2.0 * kMass), 1e-12);
  island.setExternalWrench(scene.proxy, Vec3::Zero(), Vec3::Zero());
  island.setMass(scene.proxy, kMass, Vec3::Zero(), 1.0);
  scene.run(0.1);
  EXPECT_NEAR(island.state(scene.proxy).v_W.x(), 0.3 * std::exp(-1.0), 1e-12);
}

TEST_P(IslandShare, GhostStaysAndIsPassed) {
  island.setGhost(scene.cube, true);
  EXPECT_TRUE(island.isGhost(scene.cube));
  EXPECT_FALSE(island.isDynamic(scene.cube));
  scene.move(scene.hand, Vec3(0.015, 0, 0));
  island.setExternalWrench(scene.cube, Vec3(1, 0, 0), Vec3::Zero());
  island.applyImpulse(scene.cube, Vec3(1, 0, 0), Vec3::Zero());
  EXPECT_EQ(island.computeContactForce(scene.hand), Vec3(0, 0, 0));
  scene.run(0.1);
  EXPECT_EQ(scene.x(scene.cube), 0.0);
  EXPECT_NEAR(island.computeOverlap(scene.cube), 0.015, 1e-12);
  EXPECT_EQ(island.computeOverlap(scene.hand), 0.0);  // other ghosts do not count
}

TEST_P(IslandShare, GhostIsCarriedAndGoesOnFromThere) {
  island.setExternalWrench(scene.proxy, Vec3::Zero(), Vec3::Zero());
  island.setCouplerShare(scene.proxy_tie, 0.0);
  island.setGhost(scene.proxy, true);
  scene.move(scene.proxy, Vec3(0.1, 0, 0), Vec3(0.3, 0, 0));
  const double x = scene.x(scene.proxy);
  scene.run(0.01);
  EXPECT_EQ(scene.x(scene.proxy), x);
  island.setGhost(scene.proxy, false);
  scene.run(0.01);
  EXPECT_NEAR(scene.x(scene.proxy), x + 0.003, 1e-12);
}

TEST_P(IslandShare, SharesThatComeBackLeaveNoTrace) {
  Scene other(GetParam());
  const auto poke = [](Scene& s) {
    s.move(s.hand, Vec3(1e-3, 0, 0), Vec3(0.05, 0, 0));
    s.run(0.05);
  };
  for (const double share : {0.3, 1.0}) {
    island.setCouplerShare(scene.cube_tie, share);
    island.setCouplerShare(scene.proxy_tie, share);
    island.setContactShare(scene.proxy, share);
    island.setExtraDamping(scene.proxy, 1.0 - share);
    island.setGhost(scene.proxy, share < 1.0);
  }
  poke(scene), poke(other);
  for (const BodyIndex b : {scene.hand, scene.cube, scene.proxy}) {
    EXPECT_EQ(island.state(b).p_W, other.island.state(b).p_W);
    EXPECT_EQ(island.state(b).v_W, other.island.state(b).v_W);
  }
}

TEST_P(IslandShare, AGainThatFallsTakesEnergyAndMakesNone) {
  // A hand pushes the cube against the proxy while all couplers fade.
  const auto energy = [&] {
    double sum = 0.0;
    for (const BodyIndex b : {scene.cube, scene.proxy})
      sum += 0.5 * kMass * island.state(b).v_W.squaredNorm();
    for (const CouplerIndex c : {scene.proxy_tie, scene.cube_tie})
      sum += 0.5 * island.couplerShare(c) * kTie.stiffness *
             (island.target(c).p_W - island.state(island.follower(c)).p_W).squaredNorm();
    const double gap_left = scene.x(scene.cube) - scene.x(scene.hand) - kHalf - kRadius;
    const double gap_right = scene.x(scene.proxy) - scene.x(scene.cube) - kHalf - kRadius;
    for (const double overlap : {-gap_left, -gap_right})
      if (overlap > 0.0) sum += 0.5 * kContact.stiffness * overlap * overlap;
    return sum;
  };
  scene.move(scene.hand, Vec3(0.01, 0, 0));
  scene.run(0.5);
  double before = energy();
  for (int i = 0; i <= 150; ++i) {
    const double share = 1.0 - i / 150.0;
    island.setCouplerShare(scene.cube_tie, share);
    island.setCouplerShare(scene.proxy_tie, share);
    scene.run(kPeriod);
    const double now = energy();
    EXPECT_LE(now, before + 1e-9) << i;
    before = now;
  }
}

INSTANTIATE_TEST_SUITE_P(GuidedAndFree, IslandShare, ::testing::Bool());

TEST(IslandGhost, SleepsWithTheRestAndWakesIt) {
  Scene scene(false);
  scene.run(1.0);
  ASSERT_TRUE(scene.island.isAsleep());
  scene.island.setCouplerShare(scene.proxy_tie, 0.5);
  EXPECT_FALSE(scene.island.isAsleep());
  scene.island.setCouplerShare(scene.proxy_tie, 0.0);
  scene.island.setGhost(scene.proxy, true);
  scene.run(0.1);
  EXPECT_TRUE(scene.island.isAsleep());
  scene.island.setGhost(scene.proxy, true);  // the proxy is a ghost already
  EXPECT_TRUE(scene.island.isAsleep());
  scene.island.setGhost(scene.proxy, false);
  EXPECT_FALSE(scene.island.isAsleep());
}

TEST(IslandGhost, PassesObstaclesAndSlots) {
  IslandSettings settings;
  settings.obstacle_contact = kContact;
  Island island(settings);
  IslandBody body;
  body.shape = Sphere{kRadius};
  body.mass = kMass;
  body.feels_obstacles = true;
  const BodyIndex proxy = island.addBody(body);
  const BodyIndex slot = island.addSlot();
  island.prepare();
  const std::vector<Obstacle> wall = {{Box{Vec3::Constant(0.1)}, Vec3(0.105, 0, 0)}};
  island.setObstacles(wall);  // overlaps by 5 mm
  EXPECT_NEAR(island.computeOverlap(proxy), 0.005, 1e-12);
  island.setGhost(proxy, true);
  EXPECT_NEAR(island.computeOverlap(proxy), 0.005, 1e-12);
  island.advance(kPeriod);
  EXPECT_EQ(island.state(proxy).p_W, Vec3(0, 0, 0));
  EXPECT_EQ(island.computeContactForce(proxy), Vec3(0, 0, 0));

  IslandBody neighbour;
  neighbour.shape = Box{Vec3::Constant(kHalf)};
  neighbour.mass = kMass;
  neighbour.start.p_W.x() = -0.022;
  island.fill(slot, neighbour);
  EXPECT_NEAR(island.computeOverlap(proxy), 0.008, 1e-12);
  island.advance(kPeriod);
  EXPECT_EQ(island.state(slot).v_W, Vec3(0, 0, 0));
  island.setGhost(proxy, false);
  island.setContactShare(proxy, 0.5);
  EXPECT_NEAR(island.computeContactForce(slot).x(), -0.5 * 4000.0 * 0.008, 1e-9);
}

}  // namespace
}  // namespace tandem
