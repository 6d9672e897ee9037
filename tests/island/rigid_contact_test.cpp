// Rigid contact of an island's bodies. Formulas find the contacts: spheres and boxes on a plane,
// spheres with each other.

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kStep = 1.0 / 4000.0;  // [s]
constexpr double kTick = 1e-3;          // [s]
constexpr double kMass = 0.2;           // [kg]
constexpr double kRadius = 0.02;        // [m]
constexpr double kWeight = 9.81 * kMass;

/// Bodies above the plane z = 0: spheres given by their centre, boxes by their corners.
class PlaneWorld final : public ContactFinder {
 public:
  void lookAround(const std::vector<RigidState>& states, const std::vector<double>& reach,
                  std::vector<char>& awake, std::vector<char>& near) noexcept override {
    ++looks;
    for (std::size_t again = 0; again < states.size(); ++again)
      for (std::size_t a = 0; a < states.size(); ++a) {
        if (reach[a] < 0.0) continue;
        if (awake[a] && states[a].p_W.z() - kRadius * std::sqrt(3.0) < reach[a]) near[a] = 1;
        for (std::size_t b = 0; b < a; ++b) {
          const double gap = (states[a].p_W - states[b].p_W).norm() - 2.0 * kRadius;
          if (reach[b] < 0.0 || (!awake[a] && !awake[b]) || gap > reach[a] + reach[b]) continue;
          awake[a] = awake[b] = 1;
          near[a] = near[b] = 1;
        }
      }
  }

  void find(const std::vector<RigidState>& states,
            std::vector<RigidContact>& contacts) noexcept override {
    ++searches;
    for (std::size_t a = 0; a < states.size(); ++a) {
      for (const Vec3& corner : are_boxes ? corners() : std::vector<Vec3>{Vec3::Zero()}) {
        Vec3 p_W = states[a].p_W + states[a].q_WB * corner;
        if (!are_boxes) p_W.z() -= kRadius;
        add(contacts, static_cast<BodyIndex>(a), kStanding, p_W, Vec3::UnitZ(), p_W.z());
      }
      if (are_boxes) continue;
      for (std::size_t b = 0; b < a; ++b) {
        const Vec3 apart = states[a].p_W - states[b].p_W;
        const Vec3 n = apart.normalized();
        add(contacts, static_cast<BodyIndex>(a), static_cast<BodyIndex>(b),
            states[b].p_W + kRadius * n, n, apart.norm() - 2.0 * kRadius);
      }
    }
  }

  double friction = 0.0, restitution = 0.0;
  Vec3 belt_W = Vec3::Zero();
  bool are_boxes = false;
  int looks = 0, searches = 0;

 private:
  static std::vector<Vec3> corners() {
    std::vector<Vec3> all;
    for (int i = 0; i < 8; ++i)
      all.emplace_back(i & 1 ? kRadius : -kRadius, i & 2 ? kRadius : -kRadius,
                       i & 4 ? kRadius : -kRadius);
    return all;
  }
  void add(std::vector<RigidContact>& contacts, BodyIndex a, BodyIndex b, const Vec3& p_W,
           const Vec3& n_W, double distance) const noexcept {
    if (distance > 1e-3 || contacts.size() == contacts.capacity()) return;
    contacts.push_back({a, b, p_W, n_W, b == kStanding ? belt_W : Vec3::Zero(), distance, friction,
                        restitution, 0.0});
  }
};

struct RigidIsland {
  PlaneWorld world;
  Island island;

  explicit RigidIsland(const std::vector<Vec3>& starts, bool are_boxes = false,
                       bool has_weight = true)
      : island(makeSettings()) {
    world.are_boxes = are_boxes;
    for (const Vec3& start : starts) {
      IslandBody body;
      if (are_boxes) {
        body.shape = Box{Vec3::Constant(kRadius)};
      } else {
        body.shape = Sphere{kRadius};
      }
      body.mass = kMass;
      const double radius_squared = kRadius * kRadius;
      body.inertia_B = Vec3::Constant((are_boxes ? 2.0 / 3.0 : 0.4) * kMass * radius_squared);
      body.is_rigid = true;
      body.start.p_W = start;
      island.addBody(body);
    }
    island.setContactFinder(&world);
    island.prepare();
    for (BodyIndex b = 0; b < island.bodyCount(); ++b)
      island.setExternalWrench(b, has_weight ? Vec3(0, 0, -kWeight) : Vec3::Zero(), Vec3::Zero());
  }
  static IslandSettings makeSettings() {
    IslandSettings settings;
    settings.haptic_period = kTick;
    settings.inner_step = kStep;
    return settings;
  }
  void setVelocity(BodyIndex body, const Vec3& v_W) {
    RigidState state = island.state(body);
    state.v_W = v_W;
    island.setState(body, state);
  }
  void run(double duration) {
    for (int i = 0; i < static_cast<int>(std::lround(duration / kTick)); ++i) island.advance(kTick);
  }
  [[nodiscard]] Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (BodyIndex b = 0; b < island.bodyCount(); ++b) sum += kMass * island.state(b).v_W;
    return sum;
  }
};

TEST(RigidContact, HoldsASphereAtRestToRounding) {
  RigidIsland scene({Vec3(0, 0, kRadius)});
  scene.run(0.04);
  EXPECT_NEAR(scene.island.state(0).p_W.z(), kRadius, 1e-15);
  EXPECT_NEAR(scene.island.state(0).v_W.norm(), 0.0, 1e-15);
}

// An impact takes effect at its own moment, anywhere in the step: free fall, then rest on the
// plane.
TEST(RigidContact, StopsAnImpactAtItsMoment) {
  for (int phase = 0; phase < 16; ++phase) {
    const double height = 1e-3 + 1e-5 * phase;
    RigidIsland scene({Vec3(0, 0, kRadius + height)});
    scene.setVelocity(0, Vec3(0.1, 0, -0.3));
    double lowest = 1.0;
    for (int i = 0; i < 10; ++i) {
      scene.island.advance(kTick);
      lowest = std::min(lowest, scene.island.state(0).p_W.z());
    }
    EXPECT_GT(lowest, kRadius - 1e-9) << "phase " << phase;
    // gamma assumes a uniform approach within the step; the error is g h^2 / 8.
    EXPECT_NEAR(scene.island.state(0).p_W.z(), kRadius, 1e-7) << "phase " << phase;
    EXPECT_NEAR(scene.island.state(0).v_W.z(), 0.0, 1e-9) << "phase " << phase;
  }
}

TEST(RigidContact, BouncesWithItsRestitution) {
  RigidIsland scene({Vec3(0, 0, kRadius + 1e-3)}, false, false);
  scene.world.restitution = 0.6;
  scene.setVelocity(0, Vec3(0, 0, -0.5));
  scene.run(0.01);
  EXPECT_NEAR(scene.island.state(0).v_W.z(), 0.3, 1e-9);
  // The sphere moves 2 ms down and 8 ms up. In uniform motion the moment is exact to rounding.
  EXPECT_NEAR(scene.island.state(0).p_W.z(), kRadius + 0.3 * 8e-3, 1e-9);
}

// v = v0 - mu g t; the box stops at x = v0^2 / (2 mu g).
TEST(RigidContact, BrakesASlidingBoxByCoulombsLaw) {
  RigidIsland scene({Vec3(0, 0, kRadius)}, true);
  scene.world.friction = 0.3;
  scene.setVelocity(0, Vec3(0.2, 0.1, 0));
  const double v0 = std::hypot(0.2, 0.1), a = 0.3 * 9.81;
  scene.run(0.05);
  EXPECT_NEAR(scene.island.state(0).v_W.norm(), v0 - a * 0.05, 1e-6);
  scene.run(0.1);
  EXPECT_NEAR(scene.island.state(0).v_W.norm(), 0.0, 1e-9);
  // The last step stops within itself; the error is at most mu g h^2.
  EXPECT_NEAR(scene.island.state(0).p_W.head<2>().norm(), v0 * v0 / (2 * a), a * kStep * kStep);
}

TEST(RigidContact, SticksBelowTheLimitOfFriction) {
  RigidIsland scene({Vec3(0, 0, kRadius)}, true);
  scene.world.friction = 0.5;
  scene.island.setExternalWrench(0, Vec3(0.45 * kWeight, 0.1 * kWeight, -kWeight), Vec3::Zero());
  scene.run(0.5);
  EXPECT_LT((scene.island.state(0).p_W - Vec3(0, 0, kRadius)).norm(), 1e-8);
}

// A push at its top above half its weight tips a box about its far edge. Just below, the box
// stands.
TEST(RigidContact, TipsABoxAtHalfItsWeight) {
  for (const double push : {0.48, 0.52}) {
    RigidIsland scene({Vec3(0, 0, kRadius)}, true);
    scene.world.friction = 2.0;
    scene.island.setExternalWrench(0, Vec3(push * kWeight, 0, -kWeight),
                                   Vec3(0, push * kWeight * kRadius, 0));
    scene.run(0.2);
    const double tilt = scene.island.state(0).q_WB.angularDistance(Quat::Identity());
    EXPECT_EQ(tilt > 1e-2, push > 0.5) << "push " << push << " tilt " << tilt;
    EXPECT_EQ(tilt < 1e-6, push < 0.5);
  }
}

// A sphere starts with spin and slips until it rolls at v = w r = 2/7 w0 r.
TEST(RigidContact, LetsASpinningSphereRoll) {
  RigidIsland scene({Vec3(0, 0, kRadius)});
  scene.world.friction = 0.4;
  RigidState state = scene.island.state(0);
  state.w_W = Vec3(0, 20, 0);
  scene.island.setState(0, state);
  scene.run(0.2);
  EXPECT_NEAR(scene.island.state(0).v_W.x(), 2.0 / 7.0 * 20 * kRadius, 1e-5);
  EXPECT_NEAR(scene.island.state(0).w_W.y() * kRadius, scene.island.state(0).v_W.x(), 1e-6);
}

TEST(RigidContact, CarriesABoxOnABelt) {
  RigidIsland scene({Vec3(0, 0, kRadius)}, true);
  scene.world.friction = 0.5;
  scene.world.belt_W = Vec3(0.1, 0, 0);
  scene.run(0.1);
  EXPECT_NEAR(scene.island.state(0).v_W.x(), 0.1, 1e-8);
  // It reaches 0.1 m/s after v / (mu g), along half the way of constant speed.
  const double slipping = 0.1 / (0.5 * 9.81);
  EXPECT_NEAR(scene.island.state(0).p_W.x(), 0.1 * (0.1 - 0.5 * slipping), 5e-7);
}

TEST(RigidContact, KeepsMomentumInARowOfSpheres) {
  std::vector<Vec3> starts;
  for (int i = 0; i < 5; ++i)
    starts.emplace_back(i * (2 * kRadius + (i == 1 ? 0 : 1e-4)), 1e-3 * i, 1.0);
  RigidIsland scene(starts, false, false);
  scene.world.friction = 0.3;
  scene.setVelocity(0, Vec3(0.8, 0, 0));
  const Vec3 before = scene.momentum();
  double energy = 0.5 * kMass * 0.64;
  for (int i = 0; i < 100; ++i) {
    scene.island.advance(kTick);
    double now = 0.0;
    for (BodyIndex b = 0; b < 5; ++b) {
      const RigidState& s = scene.island.state(b);
      now += 0.5 * kMass * (s.v_W.squaredNorm() + 0.4 * kRadius * kRadius * s.w_W.squaredNorm());
    }
    EXPECT_LE(now, energy * (1.0 + 1e-9));
    energy = now;
  }
  EXPECT_LT((scene.momentum() - before).norm(), 1e-14);
}

TEST(RigidContact, LetsABodyRestAndWakesItWithAllItTouches) {
  RigidIsland scene({Vec3(0, 0, kRadius), Vec3(0.5, 0, kRadius)});
  scene.world.friction = 0.3;
  scene.run(0.2);
  EXPECT_TRUE(scene.island.isAsleep());
  const int searches = scene.world.searches;
  scene.run(0.1);
  EXPECT_EQ(scene.world.searches, searches);

  // The first sphere is thrown at the second, which rests until the first is near.
  scene.setVelocity(0, Vec3(2.0, 0, 0));
  EXPECT_FALSE(scene.island.isAsleep());
  scene.run(0.1);
  EXPECT_EQ(scene.island.state(1).v_W, Vec3::Zero());
  scene.run(0.3);
  EXPECT_GT(scene.island.state(1).p_W.x(), 0.51);
}

TEST(RigidContact, WakesARestingBodyByAForce) {
  RigidIsland scene({Vec3(0, 0, kRadius)}, true);
  scene.world.friction = 0.3;
  scene.run(0.2);
  ASSERT_TRUE(scene.island.isAsleep());
  scene.island.setExternalWrench(0, Vec3(0.5 * kWeight, 0, -kWeight), Vec3::Zero());
  scene.island.advance(kTick);
  EXPECT_GT(scene.island.state(0).v_W.x(), 0.1 * 9.81 * kTick);
}

// A float's host step may end just behind a tick: the first step after the push is tiny.
TEST(RigidContact, ATinyStepDoesNotSendAPushedBodyToRestAgain) {
  RigidIsland scene({Vec3(0, 0, kRadius), Vec3(0.5, 0, kRadius)}, true);
  scene.world.friction = 0.3;
  scene.run(0.2);
  scene.island.setExternalWrench(0, Vec3(0.5 * kWeight, 0, -kWeight), Vec3::Zero());
  scene.island.advance(4e-8);
  scene.run(0.1);
  EXPECT_GT(scene.island.state(0).v_W.x(), 0.1 * 9.81 * 0.1);
}

// A host's engine moves a body and does not know the island's contacts.
TEST(RigidContact, AShiftGoesNoDeeperIntoIt) {
  for (const double gap : {5e-4, 0.0, -1e-4}) {
    RigidIsland scene({Vec3(0.0, 0.0, kRadius + gap)}, true, false);
    const Quat turn(Eigen::AngleAxisd(0.01, Vec3::UnitZ()));
    scene.island.shift(0, Vec3(0.01, 0.0, -0.002), turn);
    EXPECT_NEAR(scene.island.state(0).p_W.x(), 0.01, 1e-15);
    EXPECT_NEAR(scene.island.state(0).p_W.z(), kRadius + std::min(gap, 0.0), 1e-12);
    EXPECT_NEAR(scene.island.state(0).q_WB.angularDistance(turn), 0.0, 1e-12);
    scene.island.shift(0, Vec3(0.0, 0.0, 0.003), Quat::Identity());
    EXPECT_NEAR(scene.island.state(0).p_W.z(), kRadius + std::min(gap, 0.0) + 0.003, 1e-12);
  }
}

}  // namespace
}  // namespace tandem
