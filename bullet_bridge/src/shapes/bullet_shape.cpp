#include "shapes/bullet_shape.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/compound_parts.h"
#include "coordination/src/geometry/convex_polyhedron.h"
#include "coordination/src/geometry/triangle_mesh.h"

namespace tandem {
namespace {

using BulletShape = std::unique_ptr<btCollisionShape>;

/// Bullet's compounds do not delete their children.
class OwnCompound final : public btCompoundShape {
 public:
  void add(const btTransform& pose, BulletShape child) {
    addChildShape(pose, child.get());
    own_.push_back(std::move(child));
  }

 private:
  std::vector<BulletShape> own_;
};

struct Maker {
  BulletShape operator()(const Sphere& sphere) const {
    return std::make_unique<btSphereShape>(static_cast<btScalar>(sphere.radius));
  }
  BulletShape operator()(const Box& box) const {
    return std::make_unique<btBoxShape>(toBullet(box.half_extents));
  }
  BulletShape operator()(const Capsule& capsule) const {
    const auto radius = static_cast<btScalar>(capsule.radius);
    const auto length = static_cast<btScalar>(2.0 * capsule.half_length);
    if (capsule.axis == Axis::kX) return std::make_unique<btCapsuleShapeX>(radius, length);
    if (capsule.axis == Axis::kZ) return std::make_unique<btCapsuleShapeZ>(radius, length);
    return std::make_unique<btCapsuleShape>(radius, length);
  }
  BulletShape operator()(const Cylinder& cylinder) const {
    Vec3 half = Vec3::Constant(cylinder.radius);
    half[static_cast<int>(cylinder.axis)] = cylinder.half_length;
    if (cylinder.axis == Axis::kX) return std::make_unique<btCylinderShapeX>(toBullet(half));
    if (cylinder.axis == Axis::kZ) return std::make_unique<btCylinderShapeZ>(toBullet(half));
    return std::make_unique<btCylinderShape>(toBullet(half));
  }
  BulletShape operator()(const Cone& cone) const {
    const auto radius = static_cast<btScalar>(cone.radius);
    const auto height = static_cast<btScalar>(2.0 * cone.half_length);
    auto shape = std::make_unique<btConeShape>(radius, height);
    shape->setConeUpIndex(static_cast<int>(cone.axis));
    shape->setMargin(static_cast<btScalar>(cone.rounding));
    return shape;
  }
  BulletShape operator()(const ConvexHull& hull) const {
    auto shape = std::make_unique<btConvexHullShape>();
    for (const Vec3& corner : hull.solid->vertices()) shape->addPoint(toBullet(corner), false);
    shape->setMargin(static_cast<btScalar>(hull.rounding));
    shape->recalcLocalAabb();
    return shape;
  }
  BulletShape operator()(const Plane& plane) const {
    return std::make_unique<btStaticPlaneShape>(toBullet(plane.normal_B),
                                                static_cast<btScalar>(plane.offset));
  }
  BulletShape operator()(const Compound& compound) const {
    auto shape = std::make_unique<OwnCompound>();
    for (const CompoundParts::Part& part : compound.parts->all())
      shape->add(toBullet(part.p_BC, part.q_BC), makeBulletShape(part.shape));
    return shape;
  }
  BulletShape operator()(const Mesh&) const {
    throw std::invalid_argument("a mesh cannot be a body of this world; use hulls");
  }
};

}  // namespace

std::unique_ptr<btCollisionShape> makeBulletShape(const Shape& shape) {
  return std::visit(Maker{}, shape);
}

}  // namespace tandem
