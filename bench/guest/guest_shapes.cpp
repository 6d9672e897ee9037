#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "bench/guest/guest_scalar.h"
#include "bench/guest/guest_world.h"

namespace tandem::demos::bench {
namespace {

constexpr double kHalfFloor = 4.0;    // [m]
constexpr double kFloorDepth = 0.25;  // half of a box's [m]
constexpr int kFloorCells = 6;        // on a side, of meshes

std::unique_ptr<btCollisionShape> makeHull(Draw& draw, double size) {
  auto hull = std::make_unique<btConvexHullShape>();
  const int points = draw.count(6, 14);
  for (int i = 0; i < points; ++i) hull->addPoint(toBullet(Vec3(size * draw.direction())), false);
  hull->recalcLocalAabb();
  return hull;
}

}  // namespace

btCollisionShape& GuestWorld::keep(std::unique_ptr<btCollisionShape> shape) {
  shapes_.push_back(std::move(shape));
  return *shapes_.back();
}

/// Bullet's own margin of 4 cm is larger than such cones, hulls and spheres, and their contact is
/// of no use then.
btCollisionShape& GuestWorld::makeShape(GuestShape kind, double size, std::uint64_t seed) {
  btCollisionShape& shape = makeOwnShape(kind, size, seed);
  const bool is_default =
      kind == GuestShape::kCone || kind == GuestShape::kHull || kind == GuestShape::kMultiSphere;
  if (is_default && !case_.has_large_margins) shape.setMargin(scalar(0.1 * size));
  return shape;
}

btCollisionShape& GuestWorld::makeOwnShape(GuestShape kind, double size, std::uint64_t seed) {
  Draw draw(seed, 0);
  const btScalar r = scalar(size), half = scalar(0.6 * size);
  switch (kind) {
    case GuestShape::kBox:
      return keep(
          std::make_unique<btBoxShape>(btVector3(r, scalar(size * draw.even(0.5, 1.0)), r)));
    case GuestShape::kSphere:
      return keep(std::make_unique<btSphereShape>(r));
    case GuestShape::kCapsuleX:
      return keep(std::make_unique<btCapsuleShapeX>(half, r));
    case GuestShape::kCapsuleY:
      return keep(std::make_unique<btCapsuleShape>(half, r));
    case GuestShape::kCapsuleZ:
      return keep(std::make_unique<btCapsuleShapeZ>(half, r));
    case GuestShape::kCylinder:
      return keep(std::make_unique<btCylinderShapeZ>(btVector3(r, r, r)));
    case GuestShape::kCone:
      return keep(std::make_unique<btConeShapeZ>(r, 2 * r));
    case GuestShape::kHull:
      return keep(makeHull(draw, size));
    case GuestShape::kMultiSphere: {
      const btVector3 centres[] = {btVector3(-half, 0, 0), btVector3(half, 0, 0)};
      const btScalar radii[] = {half, half};
      return keep(std::make_unique<btMultiSphereShape>(centres, radii, 2));
    }
    case GuestShape::kScaledConvex: {
      auto& child = static_cast<btConvexShape&>(keep(std::make_unique<btSphereShape>(r)));
      return keep(std::make_unique<btUniformScalingShape>(&child, scalar(draw.even(0.7, 1.2))));
    }
    case GuestShape::kCompound:
      break;
  }
  return makeCompound(draw, size);
}

/// A box with a ball, and at times more in a compound of its own, as convex decompositions and
/// links of URDF have them.
btCollisionShape& GuestWorld::makeCompound(Draw& draw, double size) {
  const btScalar r = scalar(size), half = scalar(0.6 * size);
  auto compound = std::make_unique<btCompoundShape>();
  btTransform at = btTransform::getIdentity();
  compound->addChildShape(at, &keep(std::make_unique<btBoxShape>(btVector3(r, r, half))));
  at.setOrigin(btVector3(half, 0, half));
  compound->addChildShape(at, &keep(std::make_unique<btSphereShape>(half)));
  if (draw.chance(0.5)) {
    auto inner = std::make_unique<btCompoundShape>();
    for (int i = draw.count(1, 6); i > 0; --i) {
      btCollisionShape& hull = keep(makeHull(draw, 0.5 * size));
      hull.setMargin(scalar(0.05 * size));
      inner->addChildShape(toBullet(Vec3(0.5 * size * draw.direction()), draw.rotation()), &hull);
    }
    at.setOrigin(btVector3(-half, 0, half));
    compound->addChildShape(at, &keep(std::move(inner)));
  }
  return keep(std::move(compound));
}

void GuestWorld::makeFloor() {
  const btScalar half = scalar(kHalfFloor), depth = scalar(kFloorDepth);
  btTransform pose = btTransform::getIdentity();
  btCollisionShape* shape = nullptr;
  switch (case_.floor) {
    case GuestFloor::kBox:
      shape = &keep(std::make_unique<btBoxShape>(btVector3(half, half, depth)));
      pose.setOrigin(btVector3(0, 0, -depth));
      break;
    case GuestFloor::kPlane:
      shape = &keep(std::make_unique<btStaticPlaneShape>(btVector3(0, 0, 1), scalar(0.0)));
      break;
    case GuestFloor::kMesh: {
      const double cell = 2.0 * kHalfFloor / kFloorCells;
      const auto corner = [&](int i, int j) {
        return toBullet(Vec3(i * cell - kHalfFloor, j * cell - kHalfFloor, 0.0));
      };
      for (int i = 0; i < kFloorCells; ++i)
        for (int j = 0; j < kFloorCells; ++j) {
          triangles_.addTriangle(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1));
          triangles_.addTriangle(corner(i, j), corner(i + 1, j + 1), corner(i, j + 1));
        }
      shape = &keep(std::make_unique<btBvhTriangleMeshShape>(&triangles_, true));
      break;
    }
    case GuestFloor::kHeightField: {
      const int side = kFloorCells + 1;
      heights_.assign(static_cast<std::size_t>(side * side), btScalar(0));
      shape = &keep(std::make_unique<btHeightfieldTerrainShape>(
          side, side, heights_.data(), btScalar(-1), btScalar(1), 2, false));
      const btScalar cell = scalar(2.0 * kHalfFloor / kFloorCells);
      shape->setLocalScaling(btVector3(cell, cell, 1));
      break;
    }
  }
  btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape);
  info.m_startWorldTransform = pose;
  floor_ = std::make_unique<btRigidBody>(info);
  world().addRigidBody(floor_.get());
}

btScalar GuestWorld::floorTop() const {
  const btScalar middle = floor_->getWorldTransform().getOrigin().z();
  return case_.floor == GuestFloor::kBox ? middle + scalar(kFloorDepth) : middle;
}

}  // namespace tandem::demos::bench
