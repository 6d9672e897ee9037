// Balls on shapes of all kinds. Equal surfaces must give equal motion, and no surface may create
// energy.

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/island/island.h"
#include "support/random.h"
#include "support/solids.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;           // [s]
constexpr double kRadius = 0.01;           // radius of the ball [m]
constexpr double kMass = 0.1;              // [kg]
const CouplerGains kContact{1500.0, 3.0};  // [N/m, N s/m]

std::vector<Obstacle> at(const Shape& shape) { return {{shape, Vec3::Zero(), Quat::Identity()}}; }

/// A ball that a spring pulls towards a moving target.
struct PulledBall {
  explicit PulledBall(std::vector<Obstacle> around, double tolerance = 2e-10)
      : obstacles(std::move(around)) {
    IslandSettings settings;
    settings.haptic_period = kPeriod;
    settings.obstacle_contact = kContact;
    settings.tolerance = tolerance;
    island.emplace(settings);
    island->setTouchMemory(false);  // the ball is put into shapes
    IslandBody body;
    body.shape = Sphere{kRadius};
    body.mass = kMass;
    body.feels_obstacles = true;
    ball = island->addBody(body);
    tie = island->addCoupler(ball, {{800.0, 4.0}, {}});
    island->prepare();
    island->setObstacles(obstacles);
  }

  PulledBall(const PulledBall&) = delete;

  void tick(const PointState& target) {
    RigidState to;
    to.p_W = target.p_W;
    to.v_W = target.v_W;
    if (!started) island->setState(ball, to);
    started = true;
    island->setTarget(tie, to);
    island->advance(kPeriod);
  }
  [[nodiscard]] const Vec3& p() const { return island->state(ball).p_W; }

  std::vector<Obstacle> obstacles;
  std::optional<Island> island;
  BodyIndex ball = 0;
  CouplerIndex tie = 0;
  bool started = false;
};

/// Largest difference between the paths of two balls that follow the same target over these
/// obstacles [m].
double compare(const Obstacle& one, const Obstacle& other, double duration,
               const std::function<Vec3(double)>& target) {
  // A step on a box continues across the rounded edges, on a mesh it stops there. The tiny errors
  // of all steps add up.
  constexpr double kTolerance = 1e-12;
  PulledBall a({one}, kTolerance), b({other}, kTolerance);
  double worst = 0.0;
  for (double t = 0.0; t < duration; t += kPeriod) {
    const PointState to{target(t), Vec3::Zero()};
    a.tick(to);
    b.tick(to);
    worst = std::max(worst, (a.p() - b.p()).norm());
  }
  EXPECT_GT(a.island->counters().integrated_steps, 10u) << "it never touched";
  return worst;
}

TEST(MeshFloor, IsAPlane) {
  const Obstacle floor{test::makeMesh(test::makeFloor(24, 0.011)), Vec3(0.1, 0.2, -0.3),
                       Quat(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -0.5).normalized()))};
  const Obstacle plane{Plane{}, floor.p_WB, floor.q_WB};
  const auto press = [&](double x, double y, double z) {
    return Vec3(floor.p_WB + floor.q_WB * Vec3(x, y, z));
  };
  EXPECT_LT(compare(floor, plane, 1.5,
                    [&](double t) {
                      return press(0.03 * std::cos(9.0 * t), 0.004 - 0.006 * std::sin(13.0 * t),
                                   0.04 * std::sin(7.0 * t));
                    }),
            1e-9);
  // The ball is pressed until its centre is below the floor, and slides exactly along a row of
  // corners.
  EXPECT_LT(compare(floor, plane, 1.0,
                    [&](double t) {
                      return press(0.05 * std::sin(8.0 * t), -0.03 * std::sin(4.0 * t), 0.0);
                    }),
            1e-9);
  // The ball moves fast across the floor.
  EXPECT_LT(compare(floor, plane, 0.6,
                    [&](double t) {
                      return press(0.06 * std::sin(60.0 * t), 0.004, 0.05 * std::cos(43.0 * t));
                    }),
            1e-9);
}

TEST(MeshFloor, PushesOnceAtACornerOfItsTriangles) {
  for (const double x : {0.0, 0.01, 0.005}) {
    PulledBall ball(at(test::makeMesh(test::makeFloor(12, 0.01))));
    RigidState state;
    state.p_W = Vec3(x, 0.004, 0.0);
    ball.island->setState(ball.ball, state);
    const Vec3 f_W = ball.island->computeContactForce(ball.ball);
    EXPECT_NEAR((f_W - Vec3(0.0, 0.006 * kContact.stiffness, 0.0)).norm(), 0.0, 1e-9) << x;
  }
}

class BoxOfAnotherKind : public ::testing::TestWithParam<bool> {
 protected:
  /// The same box as a mesh or as a hull.
  [[nodiscard]] Shape make(const Vec3& half) const {
    const test::Solid solid = test::makeBoxSolid(half);
    if (GetParam()) return test::makeMesh(test::cutIntoTriangles(solid));
    return test::makeHull(solid);
  }
};

TEST_P(BoxOfAnotherKind, FeelsAsABox) {
  const Vec3 half(0.03, 0.02, 0.05);
  const Quat turned(Eigen::AngleAxisd(0.4, Vec3(1.0, -1.0, 2.0).normalized()));
  const Obstacle box{Box{half}, Vec3::Zero(), turned}, same{make(half), Vec3::Zero(), turned};
  // The ball goes round edges and corners.
  EXPECT_LT(compare(box, same, 2.0,
                    [&](double t) {
                      const Vec3 place(std::cos(5.0 * t), std::sin(5.0 * t),
                                       std::sin(3.0 * t + 1.0));
                      return Vec3(turned * half.cwiseProduct(1.05 * place));
                    }),
            1e-9);
  // The ball is pressed into a face until its centre is inside.
  EXPECT_LT(compare(box, same, 1.0,
                    [&](double t) {
                      return Vec3(turned * Vec3(0.035 - 0.04 * std::sin(6.0 * t), 0.004, 0.01 * t));
                    }),
            1e-9);
}
INSTANTIATE_TEST_SUITE_P(Kinds, BoxOfAnotherKind, ::testing::Bool(),
                         [](const auto& kind) { return kind.param ? "Mesh" : "Hull"; });

// A prism of 400 sides is within R (1 - cos(pi / 400)) = 1 um of the round bar. Its normals are
// within pi / 400. Of 5 N that is 0.04 N, which stretches the spring by 50 um.
TEST(CylinderObstacle, IsNearlyAFinePrism) {
  const Obstacle bar{Cylinder{0.03, 0.04}, Vec3::Zero(), Quat::Identity()};
  const Obstacle prism{test::makeHull(test::makePrism(0.03, 0.04, 400)), Vec3::Zero(),
                       Quat::Identity()};
  EXPECT_LT(compare(bar, prism, 1.5,
                    [](double t) {
                      return Vec3(0.034 * std::cos(5.0 * t), 0.045 * std::sin(3.0 * t),
                                  0.034 * std::sin(5.0 * t));
                    }),
            5e-5);
}

// The section of a pyramid of 400 sides is within 1 um of the cone's, as of the round bar's.
TEST(ConeObstacle, IsNearlyAFinePyramid) {
  const Obstacle cone{Cone{0.03, 0.04, Axis::kY, 0.002}, Vec3::Zero(), Quat::Identity()};
  test::Solid solid = test::makePrism(0.03, 0.04, 400);
  std::vector<Vec3> corners{Vec3(0.0, 0.04, 0.0)};
  for (const Vec3& p : solid.corners)
    if (p.y() < 0.0) corners.push_back(p);
  const Obstacle pyramid{
      ConvexHull{std::make_shared<const ConvexPolyhedron>(ConvexPolyhedron::makeHull(corners)),
                 0.002},
      Vec3::Zero(), Quat::Identity()};
  EXPECT_LT(compare(cone, pyramid, 1.5,
                    [](double t) {
                      return Vec3(0.034 * std::cos(5.0 * t), 0.045 * std::sin(3.0 * t),
                                  0.034 * std::sin(5.0 * t));
                    }),
            5e-5);
}

/// An L-shaped bar along z: floor at y = 0 for x > 0, wall at x = 0 for y > 0, 40 mm each.
std::vector<Vec3> makeBracket() {
  test::Solid solid;
  const double a = 0.04, b = 0.02, z = 0.05;
  const std::vector<Vec3> outline = {{0, 0, 0},   {a, 0, 0},  {a, -b, 0},
                                     {-b, -b, 0}, {-b, a, 0}, {0, a, 0}};
  for (const double side : {-z, z})
    for (const Vec3& p : outline) solid.corners.push_back(p + Vec3(0, 0, side));
  for (int i = 0; i < 6; ++i) {
    const int next = (i + 1) % 6;
    solid.faces.push_back({i, i + 6, next + 6, next});
  }
  // Both ends are fans from the inner corner, which sees all other corners.
  solid.faces.push_back({0, 1, 2, 3, 4, 5});
  solid.faces.push_back({6, 11, 10, 9, 8, 7});
  return test::cutIntoTriangles(solid);
}

// The outline runs clockwise as seen from +z.
TEST(MeshBracket, PushesWithBothSidesOfItsGroove) {
  PulledBall ball(at(test::makeMesh(makeBracket())));
  const auto force = [&](const Vec3& p) {
    RigidState state;
    state.p_W = p;
    ball.island->setState(ball.ball, state);
    return Vec3(ball.island->computeContactForce(ball.ball) / kContact.stiffness);
  };
  EXPECT_LT((force({0.004, 0.007, 0.01}) - Vec3(0.006, 0.003, 0)).norm(), 1e-12);
  EXPECT_LT((force({0.02, 0.007, 0.01}) - Vec3(0, 0.003, 0)).norm(), 1e-12);
  // The centre is below the floor and behind the wall: both push.
  EXPECT_LT((force({0.004, -0.001, 0.01}) - Vec3(0.006, 0.011, 0)).norm(), 1e-12);
  EXPECT_LT((force({-0.001, -0.002, 0.01}) - Vec3(0.011, 0.012, 0)).norm(), 1e-12);
  // Below the nose of the floor the centre is outside again, in front of the end face.
  EXPECT_LT((force({0.045, -0.01, 0.01}) - Vec3(0.005, 0, 0)).norm(), 1e-12);
  // The centre is behind the wall.
  EXPECT_LT((force({-0.025, 0.01, 0.01}) - Vec3(-0.005, 0, 0)).norm(), 1e-12);
}

// While the centre is at most 3 mm deep, no force jumps where regions meet.
TEST(MeshBracket, ForceIsContinuous) {
  constexpr std::uint64_t kSeed = 20090301;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const Shape bracket = test::makeMesh(makeBracket());
  PulledBall ball(at(bracket));
  const auto force = [&](const Vec3& p) {
    RigidState state;
    state.p_W = p;
    ball.island->setState(ball.ball, state);
    return Vec3(ball.island->computeContactForce(ball.ball) / kContact.stiffness);
  };
  const auto distance = [&](const Vec3& p) {
    return findSphereContact(p, 0.0, bracket, Vec3::Zero(), Quat::Identity()).gap;
  };
  int touching = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p(random.uniform(-0.04, 0.06), random.uniform(-0.04, 0.06),
                 random.uniform(-0.07, 0.07));
    const Vec3 move =
        1e-4 * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto depth = [](const Vec3& c) {
      const bool low = c.x() > -0.02 && c.x() < 0.04 && c.y() > -0.02 && c.y() < 0;
      const bool high = c.x() > -0.02 && c.x() < 0 && c.y() > -0.02 && c.y() < 0.04;
      return (low || high) && std::abs(c.z()) < 0.05;
    };
    if (depth(p) || depth(p + move)) continue;
    const Vec3 before = force(p), after = force(p + move);
    touching += before != Vec3::Zero();
    // Two parts push, each with r - d in a direction that turns with the centre about its nearest
    // point.
    const double nearest = std::max(distance(p) - move.norm(), 1e-9);
    EXPECT_LE((after - before).norm(), 2.0 * move.norm() * (1.0 + kRadius / nearest))
        << p.transpose() << " to " << (p + move).transpose();
  }
  EXPECT_GT(touching, 3000);
}

// Facets of 5 mm in a bowl of 80 mm meet at about 4 degrees. Where their prisms overlap, only one
// may push.
TEST(MeshBowl, PushesOnce) {
  std::vector<Vec3> corners = test::makeFloor(20, 0.005);
  for (Vec3& p : corners) p.y() = (p.x() * p.x() + p.z() * p.z()) / 0.16;
  const Shape bowl = test::makeMesh(corners);
  PulledBall ball(at(bowl));
  test::Random random(20090305);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 foot(random.uniform(-0.03, 0.03), 0.0, random.uniform(-0.03, 0.03));
    RigidState state;
    state.p_W = foot + Vec3(0.0, foot.squaredNorm() / 0.16 + random.uniform(-0.004, 0.009), 0.0);
    ball.island->setState(ball.ball, state);
    const double push = ball.island->computeContactForce(ball.ball).norm() / kContact.stiffness;
    const double gap =
        findSphereContact(state.p_W, kRadius, bowl, Vec3::Zero(), Quat::Identity()).gap;
    EXPECT_NEAR(push, std::max(-gap, 0.0), 1e-9) << state.p_W.transpose();
  }
}

/// Relative change of a ball's energy after it hits an obstacle and flies away again.
double bounce(const Shape& shape, const Vec3& from, const Vec3& v) {
  IslandSettings settings;
  settings.haptic_period = kPeriod;
  settings.obstacle_contact = {1500.0, 0.0};
  Island island(settings);
  IslandBody body;
  body.shape = Sphere{kRadius};
  body.mass = kMass;
  body.feels_obstacles = true;
  body.start.p_W = from;
  body.start.v_W = v;
  const BodyIndex ball = island.addBody(body);
  island.prepare();
  const std::vector<Obstacle> obstacles{{shape, Vec3::Zero(), Quat::Identity()}};
  island.setObstacles(obstacles);
  for (int i = 0; i < 400; ++i) island.advance(kPeriod);
  EXPECT_EQ(island.computeContactForce(ball), Vec3::Zero()) << "still in touch";
  EXPECT_GT(island.counters().events, 0u) << "never touched";
  return island.state(ball).v_W.squaredNorm() / v.squaredNorm() - 1.0;
}

class Bounce : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static Shape make() {
    const Vec3 half(0.03, 0.02, 0.05);
    switch (GetParam()) {
      case 0:
        return Box{half};
      case 1:
        return Capsule{0.02, 0.03, Axis::kX};
      case 2:
        return Cylinder{0.03, 0.02, Axis::kZ};
      case 3:
        return test::makeHull(test::makeBoxSolid(half));
      case 4:
        return test::makeHull(test::makeOctahedron(half), 0.002);
      case 5:
        return test::makeMesh(test::cutIntoTriangles(test::makeBoxSolid(half)));
      case 6:
        return test::makeMesh(test::cutIntoTriangles(test::makeOctahedron(half)), 0.001);
      case 7:
        return test::makeMesh(test::cutIntoTriangles(test::makePrism(0.03, 0.03, 24)));
      case 8:
        return Cone{0.03, 0.03, Axis::kX};
      case 9:
        return Cone{0.03, 0.03, Axis::kZ, 0.002};
      default:
        return makeCompound({{Box{{0.03, 0.01, 0.05}}, Vec3(0.0, -0.01, 0.0)},
                             {Box{{0.01, 0.02, 0.05}}, Vec3(-0.02, 0.0, 0.0)},
                             {Sphere{0.01}, Vec3(0.02, 0.01, 0.02)}});
    }
  }
};

// At 2 m/s the overlap is 16 mm: the centre goes inside and passes other faces on its way out. A
// step across a jump of curvature, or past a capsule's core, has an error of about 1e-6. On a mesh,
// steps end there.
TEST_P(Bounce, KeepsTheEnergy) {
  constexpr std::uint64_t kSeed = 20090302;
  SCOPED_TRACE(kSeed);
  test::Random random(kSeed);
  const Shape shape = make();
  for (int i = 0; i < 100; ++i) {
    const Vec3 towards =
        Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const Vec3 at(random.uniform(-0.015, 0.015), random.uniform(-0.015, 0.015),
                  random.uniform(-0.015, 0.015));
    const double speed = i % 2 ? 2.0 : 0.4;  // [m/s]
    const double change = bounce(shape, at - 0.09 * towards, speed * towards);
    EXPECT_LT(std::abs(change), (GetParam() < 5 || GetParam() > 7 ? 3e-5 : 2e-6))
        << "flight " << i << ", " << towards.transpose();
  }
}
INSTANTIATE_TEST_SUITE_P(Shapes, Bounce, ::testing::Range(0, 11), [](const auto& kind) {
  return std::string(std::array{"Box", "Capsule", "Cylinder", "Hull", "RoundedHull", "MeshBox",
                                "MeshOctahedron", "MeshPrism", "Cone", "RoundedCone", "Compound"}
                         .at(static_cast<std::size_t>(kind.param)));
});

// Past an edge that is some micrometres away the force turns within a step, at times between the
// stages at which the step looks.
TEST(IslandShapes, PassingAnEdgeCloselyKeepsTheEnergy) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(kSeed);
  constexpr int kFlights = 600;
  test::Random random(kSeed);
  const Box box{Vec3(0.03, 0.02, 0.05)};
  double sum = 0.0;
  for (int i = 0; i < kFlights; ++i) {
    const double gap = random.logUniform(3e-6, 3e-4), angle = random.uniform(0.1, 1.47);
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 along(-out.y(), out.x(), random.uniform(-0.3, 0.3));
    const Vec3 towards = (along - 0.4 * out).normalized();
    const Vec3 at = Vec3(0.03, 0.02, 0.0) + gap * out;
    const double speed = i % 2 ? 2.0 : 0.4;  // [m/s]
    const double change = std::abs(bounce(box, at - 0.03 * towards, speed * towards));
    EXPECT_LT(change, 5e-6) << "flight " << i;
    sum += change;
  }
  EXPECT_LT(sum / kFlights, 1e-7);
}

TEST(IslandShapes, BodiesOfAllShapesTakeThePush) {
  const test::Solid octahedron = test::makeOctahedron({0.02, 0.03, 0.025});
  const Cone cone{0.03, 0.03};
  for (const Shape& shape :
       {Shape(Cylinder{0.02, 0.03, Axis::kX}), Shape(cone), Shape(test::makeHull(octahedron)),
        Shape(test::makeMesh(test::cutIntoTriangles(octahedron))),
        Shape(makeCompound({{cone}, {Sphere{0.01}, Vec3(0.05, 0.0, 0.0)}}))}) {
    IslandSettings settings;
    Island island(settings);
    IslandBody device;
    device.motion = Motion::kPrescribed;
    device.start.p_W = Vec3(0.005, 0.045, 0.004);
    const BodyIndex hip = island.addBody(device);
    IslandBody solid;
    solid.shape = shape;
    solid.mass = 0.2;
    solid.inertia_B = Vec3(6e-5, 5e-5, 7e-5);
    const BodyIndex object = island.addBody(solid);
    island.addContact(hip, object, {1000.0, 0.0});
    island.prepare();
    RigidState push = device.start;
    push.v_W = Vec3(0.0, -0.1, 0.0);
    Vec3 impulse = Vec3::Zero();
    for (int i = 0; i < 300; ++i) {
      push.p_W = device.start.p_W + i * kPeriod * push.v_W;
      island.setState(hip, push);
      island.advance(kPeriod);
    }
    impulse = solid.mass * island.state(object).v_W;
    EXPECT_LT(impulse.y(), -0.005);
    // A push beside its middle turns the body.
    EXPECT_GT(island.state(object).w_W.norm(), 0.1);
  }
}

}  // namespace
}  // namespace tandem
