// Bodies of several shapes: each part pushes the hand as a body of its own would, and pushes the
// whole body back.

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/island/island.h"
#include "support/random.h"
#include "support/solids.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // [s]
constexpr double kRadius = 0.01;  // radius of the hand [m]
constexpr CouplerGains kContact{2000.0, 0.0};
constexpr std::uint64_t kSeed = 20260302;

/// How a compound comes into the island.
enum class As { kObstacle, kSlot, kContact };

/// A hand, and a compound or several shapes.
class Scene {
 public:
  Scene() : island(makeSettings()) {
    IslandBody body;
    body.shape = Sphere{kRadius};
    body.motion = Motion::kPrescribed;
    body.feels_obstacles = true;
    hand = island.addBody(body);
  }
  Scene(const Scene&) = delete;

  /// Adds a body; the first state of the hand must be set before.
  BodyIndex add(const IslandBody& body, As as) {
    if (as == As::kSlot) {
      const BodyIndex slot = island.addSlot();
      island.prepare();
      island.fill(slot, body);
      return slot;
    }
    if (as == As::kContact) {
      const BodyIndex index = island.addBody(body);
      island.addContact(hand, index, kContact);
      island.prepare();
      return index;
    }
    obstacles.push_back({body.shape, body.start.p_W, body.start.q_WB});
    island.prepare();
    island.setObstacles(obstacles);
    return hand;
  }

  void putHand(const Vec3& p_W) {
    RigidState state;
    state.p_W = p_W;
    island.setState(hand, state);
  }
  [[nodiscard]] Vec3 force() const { return island.computeContactForce(hand); }

  /// The hand goes there at a constant velocity, and stays for a tick.
  void moveHand(const Vec3& to_W, int ticks) {
    RigidState state = island.state(hand);
    state.v_W = (to_W - state.p_W) / (ticks * kPeriod);
    island.setState(hand, state);
    for (int i = 0; i < ticks; ++i) island.advance(kPeriod);
    state = island.state(hand);
    state.v_W.setZero();
    island.setState(hand, state);
    island.advance(kPeriod);
  }

  static IslandSettings makeSettings() {
    IslandSettings settings;
    settings.haptic_period = kPeriod;
    settings.obstacle_contact = kContact;
    return settings;
  }

  Island island;
  BodyIndex hand = 0;
  std::vector<Obstacle> obstacles;
};

IslandBody makeBody(const Shape& shape, double mass) {
  IslandBody body;
  body.shape = shape;
  body.mass = mass;
  body.inertia_B = mass * Vec3(2e-3, 3e-3, 4e-3);
  return body;
}

/// Two boxes of an L in the plane z = 0: one lies along x, the other stands at its left end.
Compound makeL() {
  return makeCompound({{Box{{0.1, 0.01, 0.03}}, Vec3(0.0, 0.0, 0.0)},
                       {Box{{0.01, 0.05, 0.03}}, Vec3(-0.09, 0.06, 0.0)}});
}

// An L that is too heavy to move, with each of its arms pressed.
TEST(CompoundBody, TheHandFeelsEachArmOfAnL) {
  for (const As as : {As::kObstacle, As::kSlot, As::kContact}) {
    Scene scene;
    scene.putHand({0.05, 0.05, 0.0});
    const BodyIndex body = scene.add(makeBody(makeL(), 1e9), as);
    scene.moveHand({0.05, 0.018, 0.0}, 50);  // 2 mm into the lying arm
    EXPECT_LT((scene.force() - Vec3(0.0, 4.0, 0.0)).norm(), 1e-6);
    if (as != As::kObstacle) {
      Vec3 f_W, t_W;
      scene.island.computeWrench(body, f_W, t_W);
      EXPECT_LT((f_W - Vec3(0.0, -4.0, 0.0)).norm(), 1e-6);
      EXPECT_LT((t_W - Vec3(0.0, 0.0, -0.2)).norm(), 1e-6);
    }
    scene.moveHand({0.05, 0.07, 0.0}, 50);
    EXPECT_EQ(scene.force(), Vec3::Zero());
    scene.moveHand({-0.073, 0.07, 0.0}, 50);  // 3 mm into the standing arm
    EXPECT_LT((scene.force() - Vec3(6.0, 0.0, 0.0)).norm(), 1e-6);
  }
}

TEST(CompoundBody, TheInnerCornerOfAnLPushesByBothArms) {
  for (const As as : {As::kObstacle, As::kSlot, As::kContact}) {
    Scene scene;
    scene.putHand({0.0, 0.06, 0.0});
    scene.add(makeBody(makeL(), 1e9), as);
    scene.moveHand({-0.072, 0.019, 0.0}, 100);  // 2 mm and 1 mm
    EXPECT_LT((scene.force() - Vec3(4.0, 2.0, 0.0)).norm(), 1e-6);
  }
}

/// A force of the world on a body that stands still at the same place.
Vec3 pressAt(const Shape& shape, As as, const Vec3& from_W, const Vec3& to_W) {
  Scene scene;
  scene.putHand(from_W);
  scene.add(makeBody(shape, 1e9), as);
  scene.moveHand(to_W, 40);
  return scene.force();
}

// Parts as obstacles of their own, the compound as an obstacle, in a slot and in a pair.
TEST(CompoundBody, DrawnCompoundsPushAsTheirPartsDo) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  int pressed = 0;
  for (int i = 0; i < 300 && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("compound " + std::to_string(i));
    std::vector<ShapePart> shapes;
    const auto add = [&](const Shape& shape) {
      shapes.push_back({shape, random.inCube(0.03), random.rotation()});
    };
    for (int k = 1 + random.below(3); k > 0; --k) add(Box{{0.03, 0.02, 0.01}});
    if (random.below(2)) add(Capsule{0.01, 0.02});
    if (random.below(2)) add(Cylinder{0.02, 0.01, Axis::kX});
    if (random.below(2)) add(test::makeHull(test::makeOctahedron({0.03, 0.02, 0.04}), 0.002));
    if (random.below(2)) add(Cone{0.02, 0.02, Axis::kZ, 0.001});
    if (random.below(2))
      add(test::makeMesh(test::cutIntoTriangles(test::makeBoxSolid({0.02, 0.02, 0.02}))));
    const Vec3 from_W = 0.2 * random.direction(), to_W = random.inCube(0.04);
    Scene apart;
    apart.putHand(from_W);
    for (const ShapePart& part : shapes)
      apart.obstacles.push_back({part.shape, part.p_BC, part.q_BC});
    apart.island.prepare();
    apart.island.setObstacles(apart.obstacles);
    apart.moveHand(to_W, 40);
    const Vec3 expected = apart.force();
    pressed += expected.norm() > 1.0;
    for (const As as : {As::kObstacle, As::kSlot, As::kContact}) {
      const Vec3 found = pressAt(makeCompound(shapes), as, from_W, to_W);
      EXPECT_LT((found - expected).norm(), 1e-6 * (1.0 + expected.norm()));
    }
  }
  EXPECT_GT(pressed, 150);
}

// Beside overlapping parts the hand's force is a continuous function of its place. Each part pushes
// with r - d, in a direction that turns with the centre about its nearest point.
TEST(CompoundBody, ForceIsContinuousBesideItsParts) {
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  int touching = 0;
  for (int i = 0; i < 200 && !::testing::Test::HasFailure(); ++i) {
    std::vector<ShapePart> shapes;
    for (int k = 0; k < 4; ++k)
      shapes.push_back({Box{{0.03, 0.02, 0.01}}, random.inCube(0.02), random.rotation()});
    const Compound compound = makeCompound(shapes);
    Scene scene;
    scene.island.setTouchMemory(false);
    scene.add(makeBody(compound, 1e9), As::kContact);
    const auto forceAt = [&](const Vec3& p_W) {
      scene.putHand(p_W);
      return scene.force();
    };
    for (int k = 0; k < 50; ++k) {
      const Vec3 p_W = random.inCube(0.06), move = random.inCube(1e-4);
      const double nearest =
          findSphereContact(p_W, 0.0, compound, Vec3::Zero(), Quat::Identity()).gap - move.norm();
      if (!(nearest > 0.0)) continue;
      const Vec3 before = forceAt(p_W), after = forceAt(p_W + move);
      touching += before != Vec3::Zero();
      EXPECT_LE((after - before).norm(),
                4.0 * kContact.stiffness * move.norm() * (1.0 + kRadius / nearest));
    }
  }
  EXPECT_GT(touching, 500);
}

/// A hull of a box whose corners are `p_W` aside: a box body with that offset.
ConvexHull makeHullAt(const Vec3& half, const Vec3& offset, const Quat& turn) {
  std::vector<Vec3> corners;
  for (const Vec3& p : test::makeBoxSolid(half).corners) corners.push_back(offset + turn * p);
  return {std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(corners))};
}

// A free body that the hand pushes around by its box, which is beside its centre of mass.
TEST(CompoundBody, OneBoxAsideMovesTheBodyAsAHullThere) {
  test::Random random(kSeed);
  const Vec3 half(0.03, 0.02, 0.04), offset(0.02, -0.01, 0.03);
  const Quat turn = random.rotation();
  RigidState ends[2];
  int i = 0;
  for (const Shape& shape :
       {Shape(makeCompound({{Box{half}, offset, turn}})), Shape(makeHullAt(half, offset, turn))}) {
    Scene scene;
    scene.putHand({-0.2, 0.0, 0.03});
    const BodyIndex body = scene.add(makeBody(shape, 0.2), As::kContact);
    scene.moveHand({0.2, 0.01, 0.03}, 800);
    ends[i++] = scene.island.state(body);
  }
  EXPECT_GT(ends[0].p_W.norm(), 0.05);
  EXPECT_LT((ends[0].p_W - ends[1].p_W).norm(), 1e-7);
  EXPECT_LT((ends[0].w_W - ends[1].w_W).norm(), 1e-5);
}

/// A free ball hits a free compound; the sum of all momentum and the energy.
struct Account {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy = 0.0;

  void add(const IslandBody& body, const RigidState& state) {
    const Vec3 w_B = state.q_WB.conjugate() * state.w_W;
    const Vec3 spin_W = state.q_WB * Vec3(body.inertia_B.cwiseProduct(w_B));
    linear += body.mass * state.v_W;
    angular += body.mass * state.p_W.cross(state.v_W) + spin_W;
    energy +=
        0.5 * body.mass * state.v_W.squaredNorm() + 0.5 * w_B.dot(body.inertia_B.cwiseProduct(w_B));
  }
};

TEST(CompoundBody, ABlowKeepsMomentumAndEnergy) {
  Island island(Scene::makeSettings());
  const Compound shape = makeCompound({{Box{{0.05, 0.01, 0.02}}, Vec3(0.0, -0.02, 0.0)},
                                       {Box{{0.01, 0.04, 0.02}}, Vec3(-0.05, 0.03, 0.0)},
                                       {Sphere{0.02}, Vec3(0.05, 0.0, 0.01)}});
  const BodyIndex body = island.addBody(makeBody(shape, 0.3));
  IslandBody ball = makeBody(Sphere{kRadius}, 0.1);
  ball.inertia_B = Vec3::Constant(4e-6);
  ball.start.p_W = Vec3(0.01, 0.06, 0.003);
  ball.start.v_W = Vec3(-0.3, -0.7, 0.01);
  const BodyIndex sphere = island.addBody(ball);
  island.addContact(sphere, body, kContact);
  island.prepare();
  const auto take = [&] {
    Account account;
    for (const BodyIndex b : {body, sphere}) account.add(island.body(b), island.state(b));
    return account;
  };
  const Account before = take();
  bool has_met = false;
  for (int i = 0; i < 500; ++i) {
    island.advance(kPeriod);
    has_met |= island.computeOverlap(sphere) > 0.0;
  }
  const Account after = take();
  EXPECT_TRUE(has_met);
  EXPECT_EQ(island.computeOverlap(sphere), 0.0);
  EXPECT_LT((after.linear - before.linear).norm(), 1e-12);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-9);
  EXPECT_NEAR(after.energy, before.energy, 1e-6 * before.energy);
}

// A thin plate that is one part of several holds the hand that pressed through it.
TEST(CompoundBody, ATouchedFaceOfAPartHoldsTheHand) {
  const Compound shape =
      makeCompound({{Box{{0.05, 0.0005, 0.05}}}, {Box{{0.01, 0.05, 0.01}}, Vec3(0.2, 0.0, 0.0)}});
  for (const As as : {As::kObstacle, As::kSlot, As::kContact}) {
    Scene scene;
    scene.putHand({0.0, 0.03, 0.0});
    scene.add(makeBody(shape, 1e9), as);
    scene.moveHand({0.0, -0.02, 0.0}, 100);  // centre 2 cm behind the plate
    EXPECT_LT((scene.force() - Vec3(0.0, kContact.stiffness * 0.0305, 0.0)).norm(), 1e-5);
    EXPECT_NEAR(scene.island.deepestTouch(), 0.0305, 1e-6);
  }
}

// A compound that is put around the hand pushes gently, part by part.
TEST(CompoundBody, PartsThatBeginDeepPushGently) {
  Scene scene;
  scene.putHand({0.05, 0.015, 0.0});  // 5 mm in the lying arm
  const BodyIndex slot = scene.island.addSlot();
  scene.island.prepare();
  scene.island.advance(kPeriod);
  scene.island.fill(slot, makeBody(makeL(), 0.2));
  EXPECT_EQ(scene.force(), Vec3::Zero());
  double fastest = 0.0;
  for (int i = 0; i < 600; ++i) {
    scene.island.advance(kPeriod);
    const RigidState& state = scene.island.state(slot);
    fastest = std::max(fastest, state.v_W.norm());
  }
  EXPECT_EQ(scene.island.computeOverlap(scene.hand), 0.0);
  EXPECT_GT(fastest, 0.01);
  EXPECT_LT(fastest, 0.1);
}

// Thirty parts and a hand that moves among them: each tick looks at those nearby only.
TEST(CompoundBody, FarPartsAreSkipped) {
  std::vector<ShapePart> shapes;
  for (int i = 0; i < 30; ++i)
    shapes.push_back({Box{{0.01, 0.01, 0.01}}, Vec3(0.021 * (i - 15), 0.0, 0.0)});
  Scene scene;
  scene.putHand({0.0, 0.05, 0.0});
  scene.add(makeBody(makeCompound(shapes), 1e9), As::kContact);
  scene.moveHand({0.0, 0.018, 0.0}, 50);
  const auto before = scene.island.counters();
  for (int i = 0; i < 100; ++i) {
    scene.putHand({0.0, 0.018, 0.0});
    scene.island.advance(kPeriod);
  }
  const auto after = scene.island.counters();
  EXPECT_GT(scene.force().norm(), 1.0);
  EXPECT_LE(after.contact_searches - before.contact_searches, 300u);
  EXPECT_GE(after.contact_searches_skipped - before.contact_searches_skipped, 2700u);
}

// A mesh is a body like any other, alone or as a part.
TEST(CompoundBody, AMeshThatTurnsPushesTheHand) {
  const Mesh mesh = test::makeMesh(test::cutIntoTriangles(test::makeBoxSolid({0.03, 0.02, 0.03})));
  for (const Shape& shape :
       {Shape(mesh), Shape(makeCompound({{mesh}})), Shape(Box{{0.03, 0.02, 0.03}})}) {
    Scene scene;
    scene.putHand({0.0, 0.05, 0.0});
    IslandBody body = makeBody(shape, 1.0);
    body.motion = Motion::kPrescribed;
    body.start.w_W = Vec3(0.0, 0.0, 1.0);
    scene.add(body, As::kContact);
    for (int i = 0; i < 100; ++i) scene.island.advance(kPeriod);
    scene.moveHand({0.0, 0.028, 0.0}, 50);
    const double angle = 0.151;
    const double depth = 0.03 - 0.028 * std::cos(angle);
    const Vec3 expected = kContact.stiffness * depth * Vec3(-std::sin(angle), std::cos(angle), 0.0);
    EXPECT_LT((scene.force() - expected).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace tandem
