#include "surroundings/private_copies.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "coordination/src/geometry/convex_polyhedron.h"
#include "shapes/only_shape.h"

namespace tandem {
namespace {

/// Bullet finds no contact of two boxes across a gap. Boxes at rest on each other open and close by
/// rounding. Their copies are larger by this, and distances are corrected [m]. It is far above an
/// inner step's motion at rest, g h^2 = 6e-7, and negligible at a corner.
constexpr btScalar kBoxSkin = btScalar(5e-6);

/// Copies a shape that owns no memory, to the bit.
template <typename ShapeType>
std::unique_ptr<btCollisionShape> copyOf(const btCollisionShape& shape) {
  return std::make_unique<ShapeType>(static_cast<const ShapeType&>(shape));
}

/// Each axis has its own class.
std::unique_ptr<btCollisionShape> copyOfCylinder(const btCylinderShape& cylinder) {
  if (cylinder.getUpAxis() == 0) return copyOf<btCylinderShapeX>(cylinder);
  if (cylinder.getUpAxis() == 2) return copyOf<btCylinderShapeZ>(cylinder);
  return copyOf<btCylinderShape>(cylinder);
}

std::unique_ptr<btCollisionShape> copyOfHull(const btConvexHullShape& hull) {
  const auto* points = static_cast<const btScalar*>(hull.getUnscaledPoints()[0]);
  auto copy = std::make_unique<btConvexHullShape>(points, hull.getNumPoints(), sizeof(btVector3));
  copy->setMargin(hull.getMargin());
  copy->setLocalScaling(hull.getLocalScaling());
  if (hull.getConvexPolyhedron()) copy->initializePolyhedralFeatures();
  return copy;
}

/// Copies a shape, because the host may delete it while the haptic thread still searches. Null for
/// shapes too large or too rare to copy, which are shared: meshes, height fields, compounds.
std::unique_ptr<btCollisionShape> makeOwnShape(const btCollisionShape& shape) {
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
    const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
    return std::make_unique<btStaticPlaneShape>(plane.getPlaneNormal(), btScalar(0));
  }
  if (shape.getShapeType() == BOX_SHAPE_PROXYTYPE) {
    const auto& box = static_cast<const btBoxShape&>(shape);
    const btVector3 skin(kBoxSkin, kBoxSkin, kBoxSkin);
    auto copy = std::make_unique<btBoxShape>(box.getHalfExtentsWithMargin() + skin);
    copy->setMargin(box.getMargin());
    return copy;
  }
  switch (shape.getShapeType()) {
    case SPHERE_SHAPE_PROXYTYPE:
      return copyOf<btSphereShape>(shape);
    case CAPSULE_SHAPE_PROXYTYPE:
      return copyOf<btCapsuleShape>(shape);
    case CYLINDER_SHAPE_PROXYTYPE:
      return copyOfCylinder(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE:
      return copyOf<btConeShape>(shape);
    case CONVEX_HULL_SHAPE_PROXYTYPE:
      return copyOfHull(static_cast<const btConvexHullShape&>(shape));
    default:
      return nullptr;
  }
}

}  // namespace

PrivateCopy::PrivateCopy(btCollisionObject& host_object, BodyIndex body)
    : original(&host_object),
      host_shape(host_object.getCollisionShape()),
      index(body),
      own_shape(makeOwnShape(onlyShapeOf(*host_object.getCollisionShape()))) {
  Surface::of(host_object).applyTo(object);
  const int type = onlyShapeOf(*host_shape).getShapeType();
  if (type == STATIC_PLANE_PROXYTYPE)
    plane = static_cast<const btStaticPlaneShape*>(own_shape.get());
  if (type == BOX_SHAPE_PROXYTYPE) skin = kBoxSkin;
  // Bullet takes shapes by non-const pointer; nothing here changes them.
  object.setCollisionShape(own_shape ? own_shape.get() : host_object.getCollisionShape());
  place(btTransform::getIdentity());
}

Surface Surface::of(const btCollisionObject& object) noexcept {
  Surface surface;
  surface.friction = object.getFriction();
  surface.rolling_friction = object.getRollingFriction();
  surface.spinning_friction = object.getSpinningFriction();
  surface.restitution = object.getRestitution();
  surface.user_pointer = object.getUserPointer();
  surface.user_index = object.getUserIndex();
  surface.user_index2 = object.getUserIndex2();
  surface.user_index3 = object.getUserIndex3();
  return surface;
}

void Surface::applyTo(btCollisionObject& object) const noexcept {
  object.setFriction(friction);
  object.setRollingFriction(rolling_friction);
  object.setSpinningFriction(spinning_friction);
  object.setRestitution(restitution);
  object.setUserPointer(user_pointer);
  object.setUserIndex(user_index);
  object.setUserIndex2(user_index2);
  object.setUserIndex3(user_index3);
}

btTransform PrivateCopy::findOriginal(const Vec3& origin_W) const {
  const btTransform& host_pose = original->getWorldTransform();
  Vec3 p = fromBullet(host_pose.getOrigin()) - origin_W;
  if (plane) {
    // A plane's origin moves to its point nearest to the private origin, which keeps numbers small.
    const auto& host_plane =
        static_cast<const btStaticPlaneShape&>(onlyShapeOf(*original->getCollisionShape()));
    const Vec3 normal = fromBullet(host_pose.getBasis() * host_plane.getPlaneNormal());
    p = (normal.dot(p) + static_cast<double>(host_plane.getPlaneConstant())) * normal;
  }
  return btTransform(host_pose.getBasis(), toBullet(p));
}

void PrivateCopy::place(const btTransform& pose) {
  object.setWorldTransform(pose);
  bounds = computeRegion(*object.getCollisionShape(), pose);
}

}  // namespace tandem
