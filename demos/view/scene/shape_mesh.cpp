#include "scene/shape_mesh.h"

#include <algorithm>

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "scene/hull_mesh.h"
#include "scene/mesh_parts.h"
#include "scene/open_mesh.h"
#include "scene/round_mesh.h"

namespace tandem::view {
namespace {

ShapeMesh makeSphere(const btSphereShape& shape) {
  return makeRoundMesh({{0, 0}}, shape.getRadius(), 2);
}

ShapeMesh makeCapsule(const btCapsuleShape& shape) {
  const btScalar half = shape.getHalfHeight();
  return makeRoundMesh({{0, -half}, {0, half}}, shape.getRadius(), shape.getUpAxis());
}

/// Bullet's margin is within a cylinder's sizes and rounds its edges.
ShapeMesh makeCylinder(const btCylinderShape& shape) {
  const btScalar margin = shape.getMargin();
  const btScalar radius = std::max(btScalar(0), shape.getRadius() - margin);
  const btScalar half = shape.getHalfExtentsWithoutMargin()[shape.getUpAxis()];
  return makeRoundMesh({{0, -half}, {radius, -half}, {radius, half}, {0, half}}, margin,
                       shape.getUpAxis());
}

/// Bullet's margin comes on top of a cone's sizes.
ShapeMesh makeCone(const btConeShape& shape) {
  const btScalar half = shape.getHeight() / 2;
  return makeRoundMesh({{0, -half}, {shape.getRadius(), -half}, {0, half}}, shape.getMargin(),
                       shape.getConeUpIndex());
}

ShapeMesh makeScaled(const btUniformScalingShape& shape) {
  ShapeMesh mesh = makeShapeMesh(*shape.getChildShape());
  scaleMesh(mesh, shape.getUniformScalingFactor());
  return mesh;
}

/// Works for the compounds of Bullet and of GImpact. The children carry the compound's scaling.
template <class Compound>
ShapeMesh makeCompound(const Compound& shape) {
  ShapeMesh mesh;
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    appendPart(mesh, makeShapeMesh(*shape.getChildShape(i)), shape.getChildTransform(i));
  }
  return mesh;
}

ShapeMesh makeGImpact(const btGImpactShapeInterface& shape) {
  if (shape.getGImpactShapeType() != CONST_GIMPACT_COMPOUND_SHAPE) return makeOpenMesh(shape);
  return makeCompound(static_cast<const btGImpactCompoundShape&>(shape));
}

/// The surface of a shape that has no closed form.
ShapeMesh makeGeneral(const btCollisionShape& shape) {
  if (const auto points = findHullPoints(shape)) return makeHullMesh(*points);
  if (shape.isConvex()) {
    return makeHullMesh(findSupports(static_cast<const btConvexShape&>(shape)));
  }
  if (shape.isConcave()) return makeOpenMesh(static_cast<const btConcaveShape&>(shape));
  return {};
}

}  // namespace

ShapeMesh makeShapeMesh(const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case BOX_SHAPE_PROXYTYPE:
      return makeBoxMesh(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
    case SPHERE_SHAPE_PROXYTYPE:
      return makeSphere(static_cast<const btSphereShape&>(shape));
    case CAPSULE_SHAPE_PROXYTYPE:
      return makeCapsule(static_cast<const btCapsuleShape&>(shape));
    case CYLINDER_SHAPE_PROXYTYPE:
      return makeCylinder(static_cast<const btCylinderShape&>(shape));
    case CONE_SHAPE_PROXYTYPE:
      return makeCone(static_cast<const btConeShape&>(shape));
    case UNIFORM_SCALING_SHAPE_PROXYTYPE:
      return makeScaled(static_cast<const btUniformScalingShape&>(shape));
    case CONVEX_2D_SHAPE_PROXYTYPE:
      return makeShapeMesh(*static_cast<const btConvex2dShape&>(shape).getChildShape());
    case STATIC_PLANE_PROXYTYPE:
      return makePlaneMesh(static_cast<const btStaticPlaneShape&>(shape));
    case COMPOUND_SHAPE_PROXYTYPE:
      return makeCompound(static_cast<const btCompoundShape&>(shape));
    case GIMPACT_SHAPE_PROXYTYPE:
      return makeGImpact(static_cast<const btGImpactShapeInterface&>(shape));
    default:
      return makeGeneral(shape);
  }
}

}  // namespace tandem::view
