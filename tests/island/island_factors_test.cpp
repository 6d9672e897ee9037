// Linear and angular factors: bodies that accelerate less, or not at all, along some axes.

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/island/island.h"

namespace tandem {
namespace {

using States = std::vector<RigidState>;

constexpr double kTick = 1e-3;   // [s]
constexpr double kMass = 0.2;    // [kg]
constexpr double kHalf = 0.02;   // half the edge of a box [m]
constexpr double kTool = 0.005;  // radius of a sphere that pushes [m]
const Vec3 kPlanar(1.0, 1.0, 0.0), kAboutZ(0.0, 0.0, 1.0);
const Vec3 kInertia(2e-5, 5e-5, 8e-5);  // [kg m^2]
const Quat kOblique(Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()));

IslandBody makeBox(const Vec3& linear_factor, const Vec3& angular_factor) {
  IslandBody box;
  box.shape = Box{Vec3::Constant(kHalf)};
  box.mass = kMass;
  box.inertia_B = kInertia;
  box.linear_factor = linear_factor;
  box.angular_factor = angular_factor;
  return box;
}

/// A ball without rotation.
IslandBody makeBall(double mass, const Vec3& p_W, const Vec3& v_W = Vec3::Zero()) {
  IslandBody ball;
  ball.shape = Sphere{kTool};
  ball.mass = mass;
  ball.start.p_W = p_W;
  ball.start.v_W = v_W;
  return ball;
}

void advance(Island& island, int ticks) {
  for (int i = 0; i < ticks; ++i) island.advance(kTick);
}

struct Lone {
  Island island{IslandSettings{}};
  BodyIndex box;
  explicit Lone(const IslandBody& body) : box(island.addBody(body)) { island.prepare(); }
  const RigidState& state() { return island.state(box); }
};

TEST(IslandFactors, AreChecked) {
  Island island({});
  const double bad[] = {-1.0, std::nan(""), std::numeric_limits<double>::infinity()};
  for (const double value : bad) {
    EXPECT_THROW(island.addBody(makeBox(Vec3(1.0, value, 1.0), Vec3::Ones())),
                 std::invalid_argument);
    EXPECT_THROW(island.addBody(makeBox(Vec3::Ones(), Vec3(1.0, 1.0, value))),
                 std::invalid_argument);
  }
}

// x = v t + L f t^2 / (2 m) on each axis. A locked axis goes on at its velocity.
TEST(IslandFactors, AForceAcceleratesEachAxisByItsFactor) {
  const Vec3 factor(1.0, 0.25, 0.0), v_W(0.1, -0.2, 0.3), f_W(2.0, -3.0, 5.0);
  IslandBody body = makeBox(factor, Vec3::Ones());
  body.start.v_W = v_W;
  Lone lone(body);
  lone.island.setExternalWrench(lone.box, f_W, Vec3::Zero());
  advance(lone.island, 500);
  const double t = 0.5;
  const Vec3 a_W = factor.cwiseProduct(f_W) / kMass;
  EXPECT_NEAR((lone.state().v_W - v_W - t * a_W).norm(), 0.0, 1e-13);
  EXPECT_NEAR((lone.state().p_W - t * v_W - 0.5 * t * t * a_W).norm(), 0.0, 1e-13);
  EXPECT_EQ(lone.state().v_W.z(), v_W.z());
  EXPECT_EQ(lone.island.externalForce(lone.box), Vec3(2.0, -3.0, 0.0));
}

// Each axis oscillates with the mass m / L. The body's own damping acts on all axes alike.
TEST(IslandFactors, ACouplerPullsEachAxisByItsFactor) {
  const Vec3 factor(1.0, 0.25, 0.0);
  const double stiffness = 300.0, damping = 0.4, own = 0.1, x0 = 0.01;
  IslandBody body = makeBox(factor, Vec3::Ones());
  body.damping = own;
  body.start.v_W.z() = 0.1;
  Lone lone(body);
  const CouplerIndex coupler = lone.island.addCoupler(lone.box, {{stiffness, damping}, {}});
  lone.island.prepare();
  RigidState target;
  target.p_W = Vec3::Constant(-x0);
  lone.island.setTarget(coupler, target);
  advance(lone.island, 200);
  const double t = 0.2;
  for (int i = 0; i < 2; ++i) {
    const double c = (factor[i] * damping + own) / (2.0 * kMass);
    const double w = std::sqrt(factor[i] * stiffness / kMass - c * c);
    const double x = x0 * std::exp(-c * t) * (std::cos(w * t) + c / w * std::sin(w * t));
    EXPECT_NEAR(lone.state().p_W[i], x - x0, 1e-13) << i;
  }
  EXPECT_NEAR(lone.state().v_W.z(), 0.1 * std::exp(-own / kMass * t), 1e-13);
}

TEST(IslandFactors, ALockedTurnStaysWhateverPushes) {
  IslandBody body = makeBox(Vec3::Ones(), Vec3::Zero());
  body.start.q_WB = kOblique;
  Lone lone(body);
  const CouplerIndex coupler = lone.island.addCoupler(lone.box, {{}, {0.5, 0.01}});
  lone.island.prepare();
  RigidState target;
  target.w_W = Vec3(1.0, 2.0, 3.0);
  lone.island.setTarget(coupler, target);
  lone.island.setExternalWrench(lone.box, Vec3::Zero(), Vec3(0.1, 0.2, 0.3));
  advance(lone.island, 100);
  EXPECT_EQ(lone.state().w_W, Vec3::Zero());
  EXPECT_NEAR(lone.state().q_WB.angularDistance(kOblique), 0.0, 1e-15);
}

// Bullet turns such a body on, whatever its factor.
TEST(IslandFactors, ALockedBodyTurnsOnAtTheVelocityThatItHas) {
  const Vec3 w_W(1.0, -2.0, 0.5);
  IslandBody body = makeBox(Vec3::Ones(), Vec3::Zero());
  body.start.w_W = w_W;
  Lone lone(body);
  lone.island.setExternalWrench(lone.box, Vec3::Zero(), Vec3(0.1, 0.2, 0.3));
  advance(lone.island, 200);
  EXPECT_EQ(lone.state().w_W, w_W);
  const Quat expected(Eigen::AngleAxisd(0.2 * w_W.norm(), w_W.normalized()));
  EXPECT_NEAR(lone.state().q_WB.angularDistance(expected), 0.0, 1e-12);
}

// w' = S I^-1 S t about z, which stays as the body turns about z.
TEST(IslandFactors, ATorqueTurnsAboutTheFreeAxisOnly) {
  for (const double factor : {1.0, 0.3}) {
    IslandBody body = makeBox(Vec3::Ones(), factor * kAboutZ);
    body.start.q_WB = kOblique;
    Lone lone(body);
    lone.island.setExternalWrench(lone.box, Vec3::Zero(), Vec3(3e-4, 2e-4, 1e-4));
    advance(lone.island, 300);
    const Vec3 z_B = kOblique.conjugate() * kAboutZ;
    const double alpha = factor * 1e-4 * z_B.cwiseAbs2().cwiseQuotient(kInertia).sum();
    EXPECT_NEAR(lone.state().w_W.z(), 0.3 * alpha, 1e-8);
    EXPECT_EQ(lone.state().w_W.head<2>().norm(), 0.0);
    const Quat turn(Eigen::AngleAxisd(0.5 * 0.09 * alpha, kAboutZ));
    EXPECT_NEAR(lone.state().q_WB.angularDistance(turn * kOblique), 0.0, 1e-7);
  }
}

TEST(IslandFactors, EqualFactorsAreAnotherMass) {
  IslandBody with = makeBox(Vec3::Constant(0.5), Vec3::Constant(0.25));
  IslandBody without = makeBox(Vec3::Ones(), Vec3::Ones());
  without.mass *= 2.0;
  without.inertia_B *= 4.0;
  std::vector<RigidState> ends;
  for (IslandBody body : {with, without}) {
    body.start.q_WB = kOblique;
    body.start.w_W = Vec3(3.0, -5.0, 8.0);
    body.damping = body.mass;  // the same decay
    Lone lone(body);
    lone.island.setExternalWrench(lone.box, Vec3(1.0, 2.0, 3.0), Vec3(1e-4, 0.0, 2e-4));
    advance(lone.island, 300);
    ends.push_back(lone.state());
  }
  EXPECT_NEAR((ends[0].p_W - ends[1].p_W).norm(), 0.0, 1e-12);
  EXPECT_NEAR((ends[0].w_W - ends[1].w_W).norm(), 0.0, 1e-6);
}

TEST(IslandFactors, AnImpulseIsMomentumWhateverTheFactors) {
  Lone lone(makeBox(kPlanar, kAboutZ));
  const Vec3 v_W(0.1, 0.2, 0.3), w_W(1.0, 2.0, 3.0);
  lone.island.applyImpulse(lone.box, kMass * v_W, kInertia.cwiseProduct(w_W));
  EXPECT_NEAR((lone.state().v_W - v_W).norm(), 0.0, 1e-15);
  EXPECT_NEAR((lone.state().w_W - w_W).norm(), 0.0, 1e-14);
}

/// A ball that flies into a box, off its centre and out of its plane.
struct Hit {
  static constexpr double kBallMass = 0.05;
  Island island{IslandSettings{}};
  BodyIndex box, ball;

  Hit(const Vec3& linear_factor, const Vec3& angular_factor) {
    box = island.addBody(makeBox(linear_factor, angular_factor));
    ball = island.addBody(makeBall(kBallMass, Vec3(-0.03, 0.012, 0.007), Vec3(0.4, 0.0, 0.0)));
    island.addContact(ball, box, {2000.0, 0.0});
    island.prepare();
  }
  [[nodiscard]] double energy() const {
    const RigidState &b = island.state(box), &s = island.state(ball);
    const IslandBody& own = island.body(box);
    // Kinetic energy of free axes: m v^2 / L. Turning is about z only, or free with I.
    double sum = kBallMass * s.v_W.squaredNorm();
    for (int i = 0; i < 3; ++i)
      if (own.linear_factor[i] > 0.0) sum += kMass * b.v_W[i] * b.v_W[i] / own.linear_factor[i];
    if (own.angular_factor.z() > 0.0)
      sum += kInertia.z() * b.w_W.z() * b.w_W.z() / own.angular_factor.z();
    return 0.5 * sum;
  }
  /// Angular momentum about z through the origin.
  [[nodiscard]] double spin() const {
    const RigidState &b = island.state(box), &s = island.state(ball);
    return (kMass * b.p_W.cross(b.v_W) + kBallMass * s.p_W.cross(s.v_W)).z() +
           kInertia.z() * b.w_W.z();
  }
};

TEST(IslandFactors, APlanarBodyPushedOffCentreTurnsAboutTheFreeAxisOnly) {
  Hit hit(kPlanar, kAboutZ);
  const double energy = hit.energy(), spin = hit.spin();
  advance(hit.island, 200);
  const RigidState &box = hit.island.state(hit.box), &ball = hit.island.state(hit.ball);
  EXPECT_LT(ball.v_W.x(), 0.2);  // it has bounced
  EXPECT_LT(box.w_W.z(), -0.5);
  EXPECT_EQ(box.w_W.head<2>().norm(), 0.0);
  EXPECT_EQ(box.p_W.z(), 0.0);
  EXPECT_EQ(box.v_W.z(), 0.0);
  EXPECT_NEAR(hit.energy() / energy, 1.0, 1e-6);
  EXPECT_NEAR(hit.spin() / spin, 1.0, 1e-8);
  const double momentum = kMass * box.v_W.x() + Hit::kBallMass * ball.v_W.x();
  EXPECT_NEAR(momentum, Hit::kBallMass * 0.4, 1e-9);
}

TEST(IslandFactors, ABounceKeepsItsEnergyWithAnyFactors) {
  for (const Vec3& linear : {Vec3(0.3, 1.0, 0.5), Vec3(2.0, 0.1, 1.0), Vec3(1.0, 0.0, 1.0)})
    for (const double about_z : {0.0, 0.4, 3.0}) {
      Hit hit(linear, about_z * kAboutZ);
      const double energy = hit.energy();
      advance(hit.island, 200);
      EXPECT_LT(hit.island.state(hit.ball).v_W.x(), 0.3);
      EXPECT_NEAR(hit.energy() / energy, 1.0, 1e-6) << linear.transpose() << ", " << about_z;
    }
}

TEST(IslandFactors, ABodyThatALockedAxisHoldsSleeps) {
  Lone lone(makeBox(kPlanar, kAboutZ));
  const CouplerIndex coupler = lone.island.addCoupler(lone.box, {{100.0, 10.0}, {0.1, 0.01}});
  lone.island.prepare();
  RigidState target;
  target.p_W = Vec3(0.001, 0.0, 0.05);  // out of its plane
  target.q_WB = Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX()));
  lone.island.setTarget(coupler, target);
  advance(lone.island, 5000);
  EXPECT_TRUE(lone.island.isAsleep());
  EXPECT_NEAR(lone.state().p_W.x(), 0.001, 1e-9);
  EXPECT_EQ(lone.state().p_W.z(), 0.0);
}

TEST(IslandFactors, AGuidedIslandKnowsNone) {
  IslandSettings settings;
  settings.guide = Vec3::UnitX();
  Island island(settings);
  const BodyIndex box = island.addBody(makeBox(Vec3(0.0, 1.0, 1.0), Vec3::Zero()));
  island.prepare();
  island.setExternalWrench(box, Vec3(kMass, 0.0, 0.0), Vec3::Zero());
  advance(island, 100);
  EXPECT_NEAR(island.state(box).v_W.x(), 0.1, 1e-12);
  EXPECT_FALSE(island.body(box).hasFactors());
}

/// Points of rigid contact that a test gives.
class GivenPoints final : public ContactFinder {
 public:
  using Find = std::function<void(const States&, std::vector<RigidContact>&)>;
  explicit GivenPoints(Find find) : find_(std::move(find)) {}
  void lookAround(const States&, const std::vector<double>&, std::vector<char>&,
                  std::vector<char>& near) noexcept override {
    near.assign(near.size(), 1);
  }
  void find(const States& states, std::vector<RigidContact>& contacts) noexcept override {
    find_(states, contacts);
  }

 private:
  Find find_;
};

/// The lowest corners of a box over the plane that n_W is normal to, through the origin.
GivenPoints makePlane(const Vec3& n_W, double friction) {
  return GivenPoints([=](const States& states, std::vector<RigidContact>& contacts) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner_B(i & 1 ? kHalf : -kHalf, i & 2 ? kHalf : -kHalf, i & 4 ? kHalf : -kHalf);
      const Vec3 p_W = states[0].p_W + states[0].q_WB * corner_B;
      if (n_W.dot(p_W) < 1e-3)
        contacts.push_back(
            {0, kStanding, p_W, n_W, Vec3::Zero(), n_W.dot(p_W), friction, 0.0, 0.0});
    }
  });
}

struct RigidScene {
  GivenPoints finder;
  Island island;
  RigidScene(GivenPoints points, IslandBody body) : finder(std::move(points)), island(fine()) {
    body.is_rigid = true;
    island.addBody(body);
    island.setContactFinder(&finder);
    island.prepare();
  }
  static IslandSettings fine() {
    IslandSettings settings;
    settings.inner_step = 1.0 / 4000.0;
    return settings;
  }
};

// The friction of the only tangent that can move brakes by mu g.
TEST(IslandFactors, APlanarBodyRubsAlongItsPlane) {
  IslandBody body = makeBox(kPlanar, kAboutZ);
  body.start.p_W.y() = kHalf;
  body.start.v_W.x() = 0.5;
  RigidScene scene(makePlane(Vec3::UnitY(), 0.2), body);
  scene.island.setExternalWrench(0, Vec3(0.0, -9.81 * kMass, 0.0), Vec3::Zero());
  advance(scene.island, 100);
  EXPECT_NEAR(scene.island.state(0).v_W.x(), 0.5 - 0.2 * 9.81 * 0.1, 1e-5);
  EXPECT_NEAR(scene.island.state(0).p_W.y(), kHalf, 1e-6);
  EXPECT_EQ(scene.island.state(0).p_W.z(), 0.0);
  EXPECT_NEAR(scene.island.state(0).w_W.norm(), 0.0, 1e-4);
  advance(scene.island, 400);
  EXPECT_EQ(scene.island.state(0).v_W, Vec3(Vec3::Zero()));
}

// A free box would fall onto a face.
TEST(IslandFactors, ABodyThatMayNotTurnStandsOnItsCorner) {
  IslandBody body = makeBox(Vec3::Ones(), Vec3::Zero());
  body.start.q_WB = kOblique;
  body.start.p_W.z() = 0.05;
  RigidScene scene(makePlane(Vec3::UnitZ(), 0.5), body);
  scene.island.setExternalWrench(0, Vec3(0.3 * kMass, 0.0, -9.81 * kMass), Vec3::Zero());
  advance(scene.island, 1000);
  EXPECT_NEAR(scene.island.state(0).q_WB.angularDistance(kOblique), 0.0, 1e-15);
  EXPECT_EQ(scene.island.state(0).v_W.norm(), 0.0);
}

// Its normal is locked but for a rounding: no impulse can open it, so none is tried.
TEST(IslandFactors, AContactAcrossALockedAxisMovesNothing) {
  const Vec3 n_W = Vec3(1e-7, 0.0, 1.0).normalized();
  IslandBody body = makeBox(kPlanar, kAboutZ);
  body.start.p_W.z() = kHalf - 1e-4;
  body.start.v_W.x() = 0.1;
  RigidScene scene(makePlane(n_W, 0.5), body);
  scene.island.setExternalWrench(0, Vec3(0.0, 0.0, -9.81 * kMass), Vec3::Zero());
  advance(scene.island, 500);
  EXPECT_NEAR(scene.island.state(0).v_W.x(), 0.1, 1e-12);
  EXPECT_EQ(scene.island.state(0).p_W.z(), kHalf - 1e-4);
}

// Catching up takes the factors along.
TEST(IslandFactors, ASlotTakesThem) {
  Island island({});
  const BodyIndex slot = island.addSlot();
  island.prepare();
  IslandBody body = makeBox(kPlanar, kAboutZ);
  island.fill(slot, body);
  island.setExternalWrench(slot, Vec3(0.2, 0.0, 0.2), Vec3(1e-4, 0.0, 8e-5));
  advance(island, 100);
  EXPECT_NEAR((island.state(slot).v_W - Vec3(0.1, 0.0, 0.0)).norm(), 0.0, 1e-13);
  EXPECT_NEAR((island.state(slot).w_W - Vec3(0.0, 0.0, 0.1)).norm(), 0.0, 1e-9);
  body.angular_factor = body.linear_factor = Vec3::Ones();
  island.fill(slot, body);
  island.setExternalWrench(slot, Vec3(0.0, 0.0, 0.2), Vec3::Zero());
  advance(island, 100);
  EXPECT_NEAR(island.state(slot).v_W.z(), 0.1, 1e-13);
}

}  // namespace
}  // namespace tandem
