// A face that the hand has touched holds it: it is pushed back out there, however deep it is.

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/geometry/triangle_mesh.h"
#include "coordination/src/island/island.h"

namespace tandem {
namespace {

constexpr double kPeriod = 1e-3;  // haptic period [s]
constexpr double kRadius = 0.01;  // radius of the hand [m]
constexpr double kHalf = 0.05;    // half width of the plates [m]
constexpr CouplerGains kContact{4000.0, 0.0};

std::vector<Vec3> makeCorners(const Vec3& half) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back((i & 1) ? half.x() : -half.x(), (i & 2) ? half.y() : -half.y(),
                         (i & 4) ? half.z() : -half.z());
  return corners;
}

Shape makeHull(const std::vector<Vec3>& points) {
  return ConvexHull{std::make_shared<ConvexPolyhedron>(ConvexPolyhedron::makeHull(points))};
}

/// Triangles of a hull's faces, or only of those that look up.
Shape makeMesh(const std::vector<Vec3>& points, bool only_up) {
  std::vector<Vec3> corners;
  const ConvexPolyhedron solid = ConvexPolyhedron::makeHull(points);
  for (const auto& face : solid.faces())
    if (!only_up || face.normal.y() > 0.5)
      for (int i = 1; i + 1 < face.count; ++i)
        for (const int k : {0, i, i + 1}) corners.push_back(solid.sides(face)[k].start);
  return Mesh{std::make_shared<TriangleMesh>(corners)};
}

/// A plate that lies flat: its upper side is at y = thickness / 2.
struct Plate {
  const char* name;
  double thickness;
  Shape shape;
};

std::vector<Plate> makePlates() {
  std::vector<Plate> plates;
  for (const double thickness : {0.02, 0.001}) {
    const Vec3 half(kHalf, 0.5 * thickness, kHalf);
    plates.push_back({"box", thickness, Box{half}});
    plates.push_back({"disc", thickness, Cylinder{kHalf, 0.5 * thickness}});
    plates.push_back({"hull", thickness, makeHull(makeCorners(half))});
    plates.push_back({"mesh", thickness, makeMesh(makeCorners(half), false)});
    plates.push_back({"sheet", thickness, makeMesh(makeCorners(half), true)});
    plates.push_back(
        {"compound", thickness, makeCompound({{Box{half}}, {Sphere{0.01}, Vec3(0.0, 0.0, 0.3)}})});
  }
  return plates;
}

/// A hand at a plate that stands at the origin.
class Scene {
 public:
  Scene(const Shape& shape, bool is_body, const Vec3& p_W) : island_(makeSettings()) {
    IslandBody hand;
    hand.shape = Sphere{kRadius};
    hand.motion = Motion::kPrescribed;
    hand.feels_obstacles = true;
    hand.start.p_W = p_W;
    hand_ = island_.addBody(hand);
    if (is_body) {
      IslandBody plate;
      plate.shape = shape;
      plate.motion = Motion::kHeld;
      island_.addContact(hand_, island_.addBody(plate), kContact);
    } else {
      obstacles_.push_back({shape});
    }
    island_.prepare();
    if (!is_body) island_.setObstacles(obstacles_);
  }

  [[nodiscard]] Vec3 force() const { return island_.computeContactForce(hand_); }
  [[nodiscard]] const Vec3& place() const { return island_.state(hand_).p_W; }

  /// The hand moves on by a tick; its place after it.
  void moveBy(const Vec3& step_W) {
    RigidState state = island_.state(hand_);
    state.v_W = step_W / kPeriod;
    island_.setState(hand_, state);
    island_.advance(kPeriod);
  }

  /// A hand of 0.3 kg pushes along y with `push` [N] against a device of 8 N; returns its speed.
  double push(double push, double v) {
    Vec3 f_W = force();
    if (f_W.norm() > 8.0) f_W *= 8.0 / f_W.norm();
    v += kPeriod * (f_W.y() + push) / 0.3;
    moveBy({0.0, kPeriod * v, 0.0});
    return v;
  }

 private:
  static IslandSettings makeSettings() {
    IslandSettings settings;
    settings.obstacle_contact = kContact;
    return settings;
  }

  std::vector<Obstacle> obstacles_;
  Island island_;
  BodyIndex hand_ = 0;
};

Vec3 above(double y) { return {0.013, y, 0.004}; }

TEST(GodObject, ThinPlateIsNeverPushedOnBehindItsMiddle) {
  for (const Plate& plate : makePlates()) {
    for (const bool is_body : {false, true}) {
      SCOPED_TRACE(std::string(plate.name) + (is_body ? ", a body" : ", fixed") + " of " +
                   std::to_string(plate.thickness) + " m");
      Scene scene(plate.shape, is_body, above(0.5 * plate.thickness + kRadius + 1e-3));
      double v = 0.0;
      for (int tick = 0; tick < 500; ++tick) {
        v = scene.push(-9.0, v);
        const double overlap = 0.5 * plate.thickness + kRadius - scene.place().y();
        ASSERT_NEAR(scene.force().y(), 4000.0 * std::max(0.0, overlap), 1e-6);
      }
      ASSERT_LT(scene.place().y(), -2.0 * kRadius - plate.thickness);
      // It lets go, and comes back out where it went in.
      for (int tick = 0; tick < 1000 && scene.force() != Vec3::Zero(); ++tick)
        v = scene.push(0.0, v);
      EXPECT_GT(scene.place().y(), 0.5 * plate.thickness);
    }
  }
}

// A flat face is one face, wherever it might have been cut into triangles.
TEST(GodObject, HullHoldsOverTheWholeOfAFlatFace) {
  const Shape plate = makeHull(makeCorners({kHalf, 0.01, kHalf}));
  for (const Vec3& at : {Vec3(0.013, 0, 0.004), Vec3(0.004, 0, 0.013), Vec3(-0.013, 0, 0.004),
                         Vec3(-0.004, 0, 0.013), Vec3(0.013, 0, -0.004), Vec3(0.004, 0, -0.013)}) {
    SCOPED_TRACE(at.transpose());
    Scene scene(plate, false, at + Vec3(0.0, 0.01 + kRadius + 1e-3, 0.0));
    double v = 0.0;
    for (int tick = 0; tick < 500; ++tick) {
      v = scene.push(-9.0, v);
      ASSERT_GE(scene.force().y(), 0.0);
    }
    EXPECT_LT(scene.place().y(), -0.05);
    EXPECT_GT(scene.force().y(), 4000.0 * 0.05);
  }
}

TEST(GodObject, FlatConeHoldsAHandThatWentInThroughItsBase) {
  constexpr double kHalfLength = 0.0005;
  const auto force = [](const Scene& scene) { return scene.force().y(); };
  Scene scene(Cone{kHalf, kHalfLength}, false, above(-kHalfLength - kRadius - 1e-3));
  double v = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    v = scene.push(9.0, v);
    const double overlap = scene.place().y() + kHalfLength + kRadius;
    ASSERT_NEAR(force(scene), -4000.0 * std::max(0.0, overlap), 1e-6);
  }
  ASSERT_GT(scene.place().y(), 2.0 * kRadius);
  while (scene.place().x() < kHalf + 0.02) scene.moveBy({1e-4, 0.0, 0.0});
  EXPECT_EQ(force(scene), 0.0);
  // From above it touches the side, which looks up.
  while (scene.place().x() > 0.01) scene.moveBy({-1e-4, 0.0, 0.0});
  while (scene.place().y() > -2.0 * kRadius) scene.moveBy({0.0, -1e-4, 0.0});
  EXPECT_GT(force(scene), 80.0);
}

TEST(GodObject, HandThatWentAroundTheEdgeIsFree) {
  for (const Plate& plate : makePlates()) {
    SCOPED_TRACE(plate.name);
    Scene scene(plate.shape, false, above(0.5 * plate.thickness + kRadius + 1e-3));
    const double below = -0.5 * plate.thickness - kRadius - 5e-3;
    while (scene.place().y() > below) scene.moveBy({0.0, -1e-4, 0.0});
    EXPECT_GT(scene.force().y(), 4000.0 * (plate.thickness + kRadius));
    while (scene.place().x() < kHalf + 0.02) scene.moveBy({1e-4, 0.0, 0.0});
    EXPECT_EQ(scene.force(), Vec3::Zero());
    // An open sheet pushes to its free side from some depth, whoever comes.
    if (plate.name == std::string("sheet")) continue;
    // From below it touches the lower side.
    while (scene.place().x() > 0.0) scene.moveBy({-1e-4, 0.0, 0.0});
    EXPECT_EQ(scene.force(), Vec3::Zero());
    while (scene.place().y() < below + 8e-3) scene.moveBy({0.0, 1e-4, 0.0});
    EXPECT_LT(scene.force().y(), -4.0);
  }
}

TEST(GodObject, HandThatStartsBehindAPlateIsNotPulledThrough) {
  const Plate plate = makePlates().front();
  Scene scene(plate.shape, false, above(-0.5 * plate.thickness - kRadius - 1e-3));
  while (scene.place().y() < -0.5 * plate.thickness - 0.5 * kRadius) scene.moveBy({0.0, 1e-4, 0.0});
  EXPECT_LT(scene.force().y(), -10.0);
}

/// A hand on a random path gets no energy from a fixed thing: changes of the face only take some.
TEST(GodObject, RandomPathGetsNoEnergy) {
  std::vector<Plate> things = makePlates();
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < 40; ++i)
    points.push_back(0.03 * Vec3(normal(engine), normal(engine), normal(engine)).normalized());
  things.push_back({"stone", 0.06, makeHull(points)});
  things.push_back({"stone of triangles", 0.06, makeMesh(points, false)});
  things.push_back({"rod", 0.01, Cylinder{0.005, 0.05}});
  things.push_back({"cone", 0.06, Cone{0.03, 0.03}});
  things.push_back({"flat cone", 0.01, Cone{0.05, 0.005, Axis::kX, 0.001}});
  for (const Plate& thing : things) {
    if (thing.name == std::string("sheet")) continue;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      SCOPED_TRACE(std::string(thing.name) + ", seed " + std::to_string(seed));
      std::mt19937 random(seed);
      const Vec3 start = 0.2 * Vec3(normal(random), normal(random), normal(random)).normalized();
      Scene scene(thing.shape, false, start);
      double work = 0.0, most = 0.0;
      const auto moveTo = [&](const Vec3& goal) {
        const Vec3 way = goal - scene.place();
        const int steps = 1 + static_cast<int>(way.norm() / 5e-5);
        for (int i = 0; i < steps; ++i) {
          const Vec3 f_W = scene.force();
          scene.moveBy(way / steps);
          work += 0.5 * (f_W + scene.force()).dot(way / steps);
          most = std::max(most, work);
        }
      };
      for (int leg = 0; leg < 12; ++leg)
        moveTo(0.04 * Vec3(normal(random), normal(random), normal(random)));
      moveTo(start);
      // A step across an edge counts half of the old force and half of the new one: about 1 mJ.
      EXPECT_LT(most, 0.01);
    }
  }
}

}  // namespace
}  // namespace tandem
