#include "shapes/convex_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btPolyhedralConvexShape.h>
#include <BulletCollision/CollisionShapes/btStridingMeshInterface.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/convex_polyhedron.h"
#include "shapes/thick_hull.h"

namespace tandem {
namespace {

/// Components of a scaling that differ by less are equal.
constexpr double kEqual = 1e-6;

/// A multi-sphere's spheres as they are scaled; unequal scaling makes them ellipsoids.
struct Spheres {
  Vec3 scaling;
  std::vector<Vec3> centres;
  std::vector<double> radii;  ///< before scaling [m]

  explicit Spheres(const btMultiSphereShape& shape)
      : scaling(fromBullet(shape.getLocalScaling()).cwiseAbs()) {
    for (int i = 0; i < shape.getSphereCount(); ++i) {
      centres.push_back(fromBullet(shape.getSpherePosition(i) * shape.getLocalScaling()));
      radii.push_back(static_cast<double>(shape.getSphereRadius(i)));
    }
  }
  [[nodiscard]] bool isScaledEqually() const {
    return scaling.maxCoeff() - scaling.minCoeff() <= kEqual * scaling.maxCoeff();
  }
  [[nodiscard]] double leastRadius() const {
    return radii.empty() ? 0.0 : *std::min_element(radii.begin(), radii.end());
  }
  [[nodiscard]] double greatestRadius() const {
    return radii.empty() ? 0.0 : *std::max_element(radii.begin(), radii.end());
  }

  /// The farthest point along a direction, of spheres whose radii are less by `inset` [m].
  [[nodiscard]] Vec3 findFarthest(const Vec3& direction, double inset) const {
    const Vec3 scaled = scaling.cwiseProduct(direction);
    const Vec3 out = scaling.cwiseProduct(scaled) / scaled.norm();
    double most = -std::numeric_limits<double>::infinity();
    Vec3 farthest = Vec3::Zero();
    for (std::size_t i = 0; i < centres.size(); ++i) {
      const Vec3 p = centres[i] + (radii[i] - inset) * out;
      if (const double height = direction.dot(p); height > most) most = height, farthest = p;
    }
    return farthest;
  }
};

std::optional<Shape> sampleSpheres(const Spheres& spheres) {
  if (spheres.centres.empty()) return std::nullopt;
  // The smallest sphere becomes the rounding, which leaves less to sample.
  const double inset = spheres.isScaledEqually() ? spheres.leastRadius() : 0.0;
  return makeSampledHull(
      [&](const Vec3& direction) { return spheres.findFarthest(direction, inset); },
      inset * spheres.scaling.x());
}

class CornerReader final : public btInternalTriangleIndexCallback {
 public:
  explicit CornerReader(std::vector<Vec3>& corners) : corners_(corners) {}
  void internalProcessTriangleIndex(btVector3* triangle, int, int) override {
    for (int i = 0; i < 3; ++i) corners_.push_back(fromBullet(triangle[i]));
  }

 private:
  std::vector<Vec3>& corners_;
};

/// A convex mesh tells its corners by its triangles only.
std::vector<Vec3> readCorners(const btConvexTriangleMeshShape& mesh) {
  std::vector<Vec3> corners;
  CornerReader reader(corners);
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  mesh.getMeshInterface()->InternalProcessAllTriangles(&reader, -far, far);
  return corners;
}

std::vector<Vec3> readCorners(const btPolyhedralConvexShape& shape) {
  if (shape.getShapeType() == CONVEX_TRIANGLEMESH_SHAPE_PROXYTYPE)
    return readCorners(static_cast<const btConvexTriangleMeshShape&>(shape));
  std::vector<Vec3> corners;
  for (int i = 0; i < shape.getNumVertices(); ++i) {
    btVector3 corner;
    shape.getVertex(i, corner);
    corners.push_back(fromBullet(corner));
  }
  return corners;
}

struct Scaler {
  double factor;

  std::optional<Shape> operator()(const Sphere& s) const { return Sphere{factor * s.radius}; }
  std::optional<Shape> operator()(const Box& s) const { return Box{factor * s.half_extents}; }
  std::optional<Shape> operator()(const Capsule& s) const {
    return Capsule{factor * s.radius, factor * s.half_length, s.axis};
  }
  std::optional<Shape> operator()(const Cylinder& s) const {
    return Cylinder{factor * s.radius, factor * s.half_length, s.axis};
  }
  std::optional<Shape> operator()(const Cone& s) const {
    return Cone{factor * s.radius, factor * s.half_length, s.axis, factor * s.rounding};
  }
  std::optional<Shape> operator()(const ConvexHull& s) const {
    std::vector<Vec3> corners = s.solid->vertices();
    for (Vec3& p : corners) p *= factor;
    return makeThickHull(corners, factor * s.rounding);
  }
  std::optional<Shape> operator()(const Plane&) const { return std::nullopt; }
  std::optional<Shape> operator()(const Mesh&) const { return std::nullopt; }
  std::optional<Shape> operator()(const Compound&) const { return std::nullopt; }
};

}  // namespace

std::optional<Shape> convertCorners(const btPolyhedralConvexShape& shape) {
  return makeThickHull(readCorners(shape), static_cast<double>(shape.getMargin()));
}

std::optional<Shape> convertEqualSpheres(const btMultiSphereShape& shape) {
  const Spheres spheres(shape);
  if (!spheres.isScaledEqually() ||
      spheres.greatestRadius() - spheres.leastRadius() > kEqual * spheres.greatestRadius())
    return std::nullopt;
  return makeThickHull(spheres.centres, spheres.scaling.x() * spheres.greatestRadius());
}

std::optional<Shape> sampleConvex(const btConvexShape& shape) {
  if (shape.getShapeType() == MULTI_SPHERE_SHAPE_PROXYTYPE)
    return sampleSpheres(Spheres(static_cast<const btMultiSphereShape&>(shape)));
  return makeSampledHull(
      [&](const Vec3& direction) {
        return fromBullet(shape.localGetSupportingVertexWithoutMargin(toBullet(direction)));
      },
      static_cast<double>(shape.getMargin()));
}

std::optional<Shape> scaleShape(const Shape& shape, double factor) {
  return std::visit(Scaler{factor}, shape);
}

}  // namespace tandem
