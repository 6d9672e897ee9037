#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/contact_geometry.h"
#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/geometry/triangle_mesh.h"
#include "support/random.h"
#include "support/solids.h"

// Properties of contact that hold for any shape in any pose. Scenes are about 1 m large, so
// rounding is near 1e-15.

namespace tandem {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRounding = 1e-13;
constexpr std::uint64_t kSeed = 20090201;

using test::Random;

/// A skew box or octahedron, somewhere near the origin.
test::Solid makeSkewSolid(double a, double b, double c, Random& random) {
  test::Solid solid = a < 0.25 ? test::makeBoxSolid({a, b, c}) : test::makeOctahedron({a, b, c});
  const Vec3 shift = random.inCube(0.2);
  const double skew = random.uniform(-0.5, 0.5);
  for (Vec3& p : solid.corners) p += shift + skew * p.y() * Vec3::UnitX();
  return solid;
}

Shape makeShape(std::size_t kind, Random& random) {
  const double a = random.uniform(0.05, 0.5), b = random.uniform(0.05, 0.5);
  const double c = random.uniform(0.05, 0.5);
  switch (kind) {
    case 0:
      return Sphere{a};
    case 1:
      return Box{{a, b, c}};
    case 2:
      return Capsule{a, b};
    case 3:
      return Plane{random.direction(), c - a};
    case 4:
      return Capsule{a, b, c < 0.25 ? Axis::kX : Axis::kZ};
    case 5:
      return Cylinder{a, b, static_cast<Axis>(static_cast<int>(20.0 * c) % 3)};
    case 6:
      return test::makeHull(makeSkewSolid(a, b, c, random));
    case 7:
      return test::makeMesh(test::cutIntoTriangles(makeSkewSolid(a, b, c, random)));
    case 8:
      return Cone{a, b, static_cast<Axis>(static_cast<int>(20.0 * c) % 3)};
    default:
      // Parts that are apart: no surface is inside another part.
      return makeCompound({{Box{0.5 * Vec3(a, b, c)}, Vec3(0.45, 0.0, 0.0), random.rotation()},
                           {Capsule{0.4 * a, 0.4 * b}, Vec3(-0.41, 0.0, 0.0), random.rotation()}});
  }
}

struct Scene {
  Shape shape;
  Vec3 p_WB;
  Quat q_WB;
  double radius;  // radius of the sphere [m]
  Vec3 p_W;       // centre of the sphere [m]

  SphereContact find() const { return findAt(p_W); }
  SphereContact findAt(const Vec3& centre) const {
    return findSphereContact(centre, radius, shape, p_WB, q_WB);
  }
};

class ContactProperties : public ::testing::TestWithParam<std::size_t> {
 protected:
  void forEachScene(int count, const std::function<void(const Scene&)>& check) {
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    for (int i = 0; i < count && !HasFailure(); ++i) {
      SCOPED_TRACE("scene " + std::to_string(i));
      const Vec3 p_WB = random_.inCube(1.0);
      check({makeShape(GetParam(), random_), p_WB, random_.rotation(), random_.uniform(0.0, 0.1),
             p_WB + random_.inCube(0.8)});
    }
  }

  Random random_{kSeed};
};

TEST_P(ContactProperties, CentreIsReachedFromTheSurfaceAlongTheNormal) {
  forEachScene(20000, [](const Scene& scene) {
    const SphereContact contact = scene.find();
    EXPECT_NEAR(contact.n_W.norm(), 1.0, 1e-15);
    const Vec3 reached = contact.p_W + contact.n_W * (contact.gap + scene.radius);
    EXPECT_NEAR((reached - scene.p_W).norm(), 0.0, kRounding);
  });
}

TEST_P(ContactProperties, NearestPointLiesOnTheSurface) {
  forEachScene(20000, [](const Scene& scene) {
    const SphereContact contact = scene.find();
    // A point on the surface has a gap of 0.
    const double gap = findSphereContact(contact.p_W, 0.0, scene.shape, scene.p_WB, scene.q_WB).gap;
    EXPECT_NEAR(gap, 0.0, kRounding);
  });
}

// A move never changes the gap by more than its own length. Event location relies on this.
TEST_P(ContactProperties, GapIsOneLipschitz) {
  forEachScene(20000, [this](const Scene& scene) {
    const double reach = std::pow(10.0, random_.uniform(-9.0, 0.0));  // [m]
    const Vec3 moved = scene.p_W + random_.inCube(reach);
    const double change = std::abs(scene.findAt(moved).gap - scene.find().gap);
    EXPECT_LE(change, (moved - scene.p_W).norm() + kRounding);
  });
}

TEST_P(ContactProperties, ResultMovesWithTheWholeScene) {
  forEachScene(20000, [this](const Scene& scene) {
    const Quat turn = random_.rotation();
    const Vec3 shift = random_.inCube(1.0);
    Scene moved = scene;
    moved.p_W = turn * scene.p_W + shift;
    moved.p_WB = turn * scene.p_WB + shift;
    moved.q_WB = turn * scene.q_WB;

    const SphereContact before = scene.find();
    const SphereContact after = moved.find();
    EXPECT_NEAR(after.gap, before.gap, kRounding);
    // A direction from a core or an edge at distance d carries rounding / d; d > 1e-4 m in these
    // scenes.
    EXPECT_NEAR((after.n_W - turn * before.n_W).norm(), 0.0, 1e-10);
    EXPECT_NEAR((after.p_W - (turn * before.p_W + shift)).norm(), 0.0, 1e-10);
  });
}

// A continuous n is the gradient of the gap. By the mean value theorem the difference
// quotient is one of the normals between the two ends.
TEST_P(ContactProperties, NormalIsTheGradientOfTheGap) {
  static constexpr double kStep = 1e-6;           // [m]
  static constexpr double kQuotientError = 1e-9;  // rounding 1e-15 over the step
  constexpr int kScenes = 20000;
  int smooth = 0;
  forEachScene(kScenes, [&smooth](const Scene& scene) {
    const Vec3 n = scene.find().n_W;
    Vec3 gradient;
    double spread = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const SphereContact ahead = scene.findAt(scene.p_W + kStep * Vec3::Unit(axis));
      const SphereContact behind = scene.findAt(scene.p_W - kStep * Vec3::Unit(axis));
      gradient[axis] = (ahead.gap - behind.gap) / (2.0 * kStep);
      spread = std::max({spread, (ahead.n_W - n).norm(), (behind.n_W - n).norm()});
    }
    if (spread > 1e-2) return;  // the step crosses a ridge
    ++smooth;
    EXPECT_NEAR((gradient - n).norm(), 0.0, 2.0 * spread + kQuotientError);
  });
  EXPECT_GT(smooth, kScenes * 99 / 100);
}

/// Distance from a point to the nearest of many sample points that cover a surface. Also bounds how
/// far any surface point is from its nearest sample.
class SampledSurface {
 public:
  explicit SampledSurface(const Vec3& from) : from_(from) {}

  double distance() const { return distance_; }
  double coveringRadius() const { return covering_radius_; }

  /// Adds the parallelogram `origin` + [-1, 1] u + [-1, 1] v, with u across v.
  void addRectangle(const Vec3& origin, const Vec3& u, const Vec3& v) {
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) add(origin + middle(i) * u + middle(j) * v);
    cover(u.norm(), v.norm());
  }

  void addTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; i + j < kSteps; ++j)
        for (const double part : {1.0, 2.0})  // both triangles of a cell
          if (i + j + part <= kSteps)
            add(a + (i + part / 3.0) / kSteps * (b - a) + (j + part / 3.0) / kSteps * (c - a));
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    covering_radius_ = std::max(covering_radius_, longest / kSteps);
  }

  void addCone(const Cone& cone) {
    const int axis = static_cast<int>(cone.axis);
    const Vec3 tip = cone.half_length * Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3),
               v = Vec3::Unit((axis + 2) % 3);
    for (int i = 0; i < kSteps; ++i) {
      const double angle = kPi * middle(i);
      const Vec3 across = cone.radius * (std::cos(angle) * u + std::sin(angle) * v);
      for (int j = 0; j < kSteps; ++j) {
        const double part = 0.5 + 0.5 * middle(j);
        add(tip + part * (across - 2.0 * tip));
        add(part * across - tip);
      }
    }
    cover(kPi * cone.radius, std::hypot(0.5 * cone.radius, cone.half_length));
    cover(kPi * cone.radius, 0.5 * cone.radius);
  }

  void addCylinder(const Cylinder& cylinder) {
    const int axis = static_cast<int>(cylinder.axis);
    const Vec3 along = Vec3::Unit(axis), u = Vec3::Unit((axis + 1) % 3),
               v = Vec3::Unit((axis + 2) % 3);
    for (int i = 0; i < kSteps; ++i) {
      const double angle = kPi * middle(i);
      const Vec3 across = cylinder.radius * (std::cos(angle) * u + std::sin(angle) * v);
      for (int j = 0; j < kSteps; ++j) {
        add(across + cylinder.half_length * middle(j) * along);
        for (const double side : {1.0, -1.0})
          add(side * cylinder.half_length * along + (0.5 + 0.5 * middle(j)) * across);
      }
    }
    cover(kPi * cylinder.radius, cylinder.half_length);
    cover(kPi * cylinder.radius, 0.5 * cylinder.radius);
  }

  /// Adds the surface of a capsule along y: by angle around the axis, along the side, then both
  /// caps.
  void addCapsule(double radius, double half_length, const Quat& turn = Quat::Identity()) {
    const auto add = [&](const Vec3& p) { this->add(turn * p); };
    for (int i = 0; i < kSteps; ++i) {
      const double around = kPi * middle(i);
      const Vec3 across = radius * Vec3(std::cos(around), 0.0, std::sin(around));
      for (int j = 0; j < kSteps; ++j) {
        add(across + half_length * middle(j) * Vec3::UnitY());
        const double up = kPi / 2 * middle(j);
        const double end = up < 0.0 ? -half_length : half_length;
        add(std::cos(up) * across + (end + radius * std::sin(up)) * Vec3::UnitY());
      }
    }
    cover(kPi * radius, half_length);
    cover(kPi * radius, kPi / 2 * radius);
  }

  void add(const SampledSurface& other) {
    distance_ = std::min(distance_, other.distance_);
    covering_radius_ = std::max(covering_radius_, other.covering_radius_);
  }
  [[nodiscard]] const Vec3& from() const { return from_; }

 private:
  static constexpr int kSteps = 200;

  /// Middles of kSteps equal cells of [-1, 1].
  static double middle(int i) { return (2.0 * i + 1.0) / kSteps - 1.0; }

  void add(const Vec3& p) { distance_ = std::min(distance_, (p - from_).norm()); }

  /// Half the diagonal of a cell, for half-lengths u and v of the whole patch.
  void cover(double u, double v) {
    covering_radius_ = std::max(covering_radius_, std::hypot(u, v) / kSteps);
  }

  Vec3 from_;
  double distance_ = std::numeric_limits<double>::infinity();
  double covering_radius_ = 0.0;
};

void addSurface(SampledSurface& surface, const Sphere& sphere) {
  surface.addCapsule(sphere.radius, 0.0);
}

void addSurface(SampledSurface& surface, const Capsule& capsule) {
  surface.addCapsule(
      capsule.radius, capsule.half_length,
      Quat::FromTwoVectors(Vec3::UnitY(), Vec3::Unit(static_cast<int>(capsule.axis))));
}

void addSurface(SampledSurface& surface, const Cylinder& cylinder) {
  surface.addCylinder(cylinder);
}

void addSurface(SampledSurface& surface, const Cone& cone) { surface.addCone(cone); }

void addSurface(SampledSurface& surface, const ConvexHull& hull) {
  const ConvexPolyhedron& solid = *hull.solid;
  for (const ConvexPolyhedron::Face& face : solid.faces()) {
    const auto* side = solid.sides(face);
    for (int i = 2; i < face.count; ++i)
      surface.addTriangle(side[0].start, side[i - 1].start, side[i].start);
  }
}

void addSurface(SampledSurface& surface, const Mesh& mesh) {
  for (const TriangleMesh::Triangle& triangle : mesh.surface->triangles())
    surface.addTriangle(triangle.corners[0].p, triangle.corners[1].p, triangle.corners[2].p);
}

void addSurface(SampledSurface& surface, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {-1.0, 1.0})
      surface.addRectangle(side * box.half_extents[axis] * Vec3::Unit(axis),
                           box.half_extents[u] * Vec3::Unit(u),
                           box.half_extents[v] * Vec3::Unit(v));
  }
}

void addSurface(SampledSurface& surface, const Plane& plane) {
  // The centre is within 0.8 sqrt(3) m of the body's origin, and so is its foot on the plane.
  const Vec3 u = plane.normal_B.unitOrthogonal();
  surface.addRectangle(plane.offset * plane.normal_B, 1.5 * u, 1.5 * plane.normal_B.cross(u));
}

Vec3 toPart(const CompoundParts::Part& part, const Vec3& p_B) {
  return part.toPart(PlainVec(p_B)).toVec3();
}

void addSurface(SampledSurface& surface, const Compound& compound) {
  for (const CompoundParts::Part& part : compound.parts->all()) {
    SampledSurface own(toPart(part, surface.from()));
    if (const auto* box = std::get_if<Box>(&part.shape)) addSurface(own, *box);
    if (const auto* capsule = std::get_if<Capsule>(&part.shape)) addSurface(own, *capsule);
    surface.add(own);
  }
}

bool isInside(const Vec3& p, const Sphere& s) { return p.norm() < s.radius; }
bool isInside(const Vec3& p, const Box& s) {
  return (p.cwiseAbs().array() < s.half_extents.array()).all();
}
bool isInside(const Vec3& p, const Capsule& s) {
  const Vec3 along = Vec3::Unit(static_cast<int>(s.axis));
  const bool in_side = along.cross(p).norm() < s.radius && std::abs(along.dot(p)) < s.half_length;
  const Vec3 end = s.half_length * along;
  return in_side || (p - end).norm() < s.radius || (p + end).norm() < s.radius;
}
bool isInside(const Vec3& p, const Plane& s) { return s.normal_B.dot(p) < s.offset; }
bool isInside(const Vec3& p, const Cylinder& s) {
  const Vec3 along = Vec3::Unit(static_cast<int>(s.axis));
  return along.cross(p).norm() < s.radius && std::abs(along.dot(p)) < s.half_length;
}
bool isInside(const Vec3& p, const Cone& s) {
  const Vec3 along = Vec3::Unit(static_cast<int>(s.axis));
  const double under_tip = s.half_length - along.dot(p);
  return under_tip < 2.0 * s.half_length &&
         along.cross(p).norm() < s.radius * under_tip / (2.0 * s.half_length);
}
bool isInside(const Vec3& p, const ConvexHull& s) {
  const auto& faces = s.solid->faces();
  return std::all_of(faces.begin(), faces.end(),
                     [&](const auto& face) { return face.normal.dot(p) < face.offset; });
}
bool isInside(const Vec3& p, const Mesh& s) {  // all shapes here are convex
  const auto& triangles = s.surface->triangles();
  return std::all_of(triangles.begin(), triangles.end(),
                     [&](const auto& one) { return one.normal.dot(p) < one.offset; });
}

bool isInside(const Vec3& p, const Compound& s) {
  const auto holds = [&](const CompoundParts::Part& part) {
    const Vec3 p_C = toPart(part, p);
    if (const auto* box = std::get_if<Box>(&part.shape)) return isInside(p_C, *box);
    return isInside(p_C, std::get<Capsule>(part.shape));
  };
  return std::any_of(s.parts->all().begin(), s.parts->all().end(), holds);
}

TEST_P(ContactProperties, DistanceAgreesWithDenselySampledSurface) {
  forEachScene(100, [](const Scene& scene) {
    const Vec3 p_B = scene.q_WB.conjugate() * (scene.p_W - scene.p_WB);
    SampledSurface surface(p_B);
    std::visit([&surface](const auto& s) { addSurface(surface, s); }, scene.shape);
    const bool inside = std::visit([&p_B](const auto& s) { return isInside(p_B, s); }, scene.shape);

    const double signed_distance = scene.find().gap + scene.radius;
    EXPECT_EQ(signed_distance < 0.0, inside);
    // No sample is nearer than the surface, and at least one is nearly as near.
    EXPECT_LE(std::abs(signed_distance), surface.distance() + kRounding);
    EXPECT_GE(std::abs(signed_distance), surface.distance() - surface.coveringRadius());
  });
}

std::string nameShape(const ::testing::TestParamInfo<std::size_t>& kind) {
  return std::array{"Sphere",   "Box",        "Capsule", "Plane", "CapsuleAlong",
                    "Cylinder", "ConvexHull", "Mesh",    "Cone",  "Compound"}
      .at(kind.param);
}

INSTANTIATE_TEST_SUITE_P(Shapes, ContactProperties, ::testing::Range<std::size_t>(0, 10),
                         nameShape);

}  // namespace
}  // namespace tandem
