#include "import/bullet/bullet_shape.h"

#include <numbers>

#include "tandem/bullet_bridge/convert.h"

#include "import/import_parts.h"
#include "terminal/usage_error.h"
#include "world/rotation.h"

namespace tandem::demos {
namespace {

/// A form with its place in the body.
using Part = PartScenario;

std::array<double, 3> toArray(const btVector3& p) { return {p.x(), p.y(), p.z()}; }

Part makeBox(const Vec3& size) {
  Part part;
  part.shape.size = size;
  return part;
}

/// Bullet's round forms stand along x, y or z; those of a scenario along z.
Part makeRound(const char* kind, double radius, double height, int up) {
  Part part;
  part.shape.kind = kind;
  part.shape.radius = radius;
  part.shape.height = height;
  const double quarter = 0.5 * std::numbers::pi;
  if (up == 0) part.rotation = quarter * Vec3::UnitY();
  if (up == 1) part.rotation = -quarter * Vec3::UnitX();
  return part;
}

Part makeSphere(const btSphereShape& sphere) {
  Part part;
  part.shape.kind = "sphere";
  part.shape.radius = sphere.getRadius();
  return part;
}

Part makeCylinder(const btCylinderShape& cylinder) {
  const int up = cylinder.getUpAxis();
  return makeRound("cylinder", cylinder.getRadius(), 2.0 * cylinder.getHalfExtentsWithMargin()[up],
                   up);
}

Part makeHull(const btConvexHullShape& hull) {
  Part part;
  part.shape.kind = "hull";
  for (int i = 0; i < hull.getNumPoints(); ++i)
    part.shape.points.push_back(toArray(hull.getScaledPoint(i)));
  return part;
}

/// Collects the triangles of a mesh.
class TriangleList final : public btTriangleCallback {
 public:
  void processTriangle(btVector3* corners, int, int) override {
    const int first = static_cast<int>(shape.points.size());
    for (int i = 0; i < 3; ++i) shape.points.push_back(toArray(corners[i]));
    shape.triangles.push_back({first, first + 1, first + 2});
  }
  ShapeScenario shape;
};

Part makeMesh(const btConcaveShape& mesh) {
  TriangleList list;
  list.shape.kind = "mesh";
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  mesh.processAllTriangles(&list, -far, far);
  return {list.shape};
}

/// A box whose top lies in the plane, about its origin.
Part makePlane(const btStaticPlaneShape& plane) {
  Part part = makeBox(Vec3(kGroundWidth, kGroundWidth, kGroundThickness));
  const Vec3 normal = fromBullet(plane.getPlaneNormal()).normalized();
  part.position = (plane.getPlaneConstant() - 0.5 * kGroundThickness) * normal;
  part.rotation =
      makeRotationVector(Quat::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix());
  return part;
}

Part makePart(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return makeBox(2.0 *
                     fromBullet(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin()));
    case SPHERE_SHAPE_PROXYTYPE:
      return makeSphere(static_cast<const btSphereShape&>(shape));
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(shape);
      return makeRound("capsule", capsule.getRadius(), 2.0 * capsule.getHalfHeight(),
                       capsule.getUpAxis());
    }
    case CYLINDER_SHAPE_PROXYTYPE:
      return makeCylinder(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE: {
      const auto& cone = static_cast<const btConeShape&>(shape);
      return makeRound("cone", cone.getRadius(), cone.getHeight(), cone.getConeUpIndex());
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return makeHull(static_cast<const btConvexHullShape&>(shape));
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
      return makeMesh(static_cast<const btConcaveShape&>(shape));
    case STATIC_PLANE_PROXYTYPE:
      return makePlane(static_cast<const btStaticPlaneShape&>(shape));
    default:
      throw UsageError(std::string("a ") + shape.getName() + " is not taken over; use hulls");
  }
}

/// Adds a shape, and the children of a compound, at their places in the body.
void addParts(const btCollisionShape& shape, const btTransform& X_BS, BodyScenario& body) {
  if (shape.isCompound()) {
    const auto& compound = static_cast<const btCompoundShape&>(shape);
    for (int i = 0; i < compound.getNumChildShapes(); ++i)
      addParts(*compound.getChildShape(i), X_BS * compound.getChildTransform(i), body);
    return;
  }
  Part part = makePart(shape);
  const Mat3 R_BS = fromBullet(X_BS.getRotation()).toRotationMatrix();
  part.position = fromBullet(X_BS.getOrigin()) + R_BS * part.position;
  part.rotation = makeRotationVector(R_BS * makeRotation(part.rotation).toRotationMatrix());
  body.parts.push_back(part);
}

}  // namespace

void takeShape(const btCollisionShape& shape, BodyScenario& body) {
  addParts(shape, btTransform::getIdentity(), body);
  joinOnlyPart(body);
}

}  // namespace tandem::demos
