#include <bit>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "scene/hull_mesh.h"
#include "scene/shape_mesh.h"

namespace tandem::view {
namespace {

/// Mixes values into one number.
class KeyMixer {
 public:
  void add(std::uint64_t word) {
    key_ = (key_ ^ word) * 0x9E3779B97F4A7C15U;
    key_ ^= key_ >> 32U;
  }
  void add(int count) { add(static_cast<std::uint64_t>(count)); }
  void add(const void* address) { add(std::bit_cast<std::uint64_t>(address)); }
  void add(btScalar value) { add(std::bit_cast<std::uint64_t>(static_cast<double>(value))); }
  void add(const btVector3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  void add(const btTransform& X) {
    for (int row = 0; row < 3; ++row) add(X.getBasis()[row]);
    add(X.getOrigin());
  }
  [[nodiscard]] std::uint64_t key() const { return key_; }

 private:
  std::uint64_t key_ = 0xCBF29CE484222325U;
};

/// Adds where a mesh's triangles are and how many it has, but not what they are: that would cost as
/// much as the mesh.
void addMesh(KeyMixer& mixer, const btStridingMeshInterface& mesh) {
  mixer.add(&mesh);
  mixer.add(mesh.getScaling());
  for (int part = 0; part < mesh.getNumSubParts(); ++part) {
    const unsigned char *vertices = nullptr, *indices = nullptr;
    int vertex_count = 0, stride = 0, index_stride = 0, face_count = 0;
    PHY_ScalarType vertex_type = PHY_FLOAT, index_type = PHY_INTEGER;
    mesh.getLockedReadOnlyVertexIndexBase(&vertices, vertex_count, vertex_type, stride, &indices,
                                          index_stride, face_count, index_type, part);
    mixer.add(vertices);
    mixer.add(vertex_count);
    mixer.add(indices);
    mixer.add(face_count);
    mesh.unLockReadOnlyVertexBase(part);
  }
}

template <class Compound>
void addChildren(KeyMixer& mixer, const Compound& shape) {
  mixer.add(shape.getNumChildShapes());
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    mixer.add(shape.getChildTransform(i));
    mixer.add(computeShapeKey(*shape.getChildShape(i)));
  }
}

void addGImpact(KeyMixer& mixer, const btGImpactShapeInterface& shape) {
  if (shape.getGImpactShapeType() == CONST_GIMPACT_COMPOUND_SHAPE) {
    addChildren(mixer, static_cast<const btGImpactCompoundShape&>(shape));
  } else if (shape.getGImpactShapeType() == CONST_GIMPACT_TRIMESH_SHAPE) {
    addMesh(mixer, *static_cast<const btGImpactMeshShape&>(shape).getMeshInterface());
  }
}

void addPlane(KeyMixer& mixer, const btStaticPlaneShape& shape) {
  mixer.add(shape.getPlaneNormal());
  mixer.add(shape.getPlaneConstant());
}

/// Adds what a height field shows of itself; its bounds tell its sizes.
void addHeightField(KeyMixer& mixer, const btHeightfieldTerrainShape& shape) {
  mixer.add(shape.getHeightfieldRawData());
  mixer.add(shape.getUpAxis());
}

void addConcave(KeyMixer& mixer, const btCollisionShape& shape) {
  switch (shape.getShapeType()) {
    case TRIANGLE_MESH_SHAPE_PROXYTYPE:
    case MULTIMATERIAL_TRIANGLE_MESH_PROXYTYPE:
      return addMesh(mixer, *static_cast<const btTriangleMeshShape&>(shape).getMeshInterface());
    case SCALED_TRIANGLE_MESH_SHAPE_PROXYTYPE:
      return mixer.add(computeShapeKey(
          *static_cast<const btScaledBvhTriangleMeshShape&>(shape).getChildShape()));
    case TERRAIN_SHAPE_PROXYTYPE:
      return addHeightField(mixer, static_cast<const btHeightfieldTerrainShape&>(shape));
    case GIMPACT_SHAPE_PROXYTYPE:
      return addGImpact(mixer, static_cast<const btGImpactShapeInterface&>(shape));
    case STATIC_PLANE_PROXYTYPE:
      return addPlane(mixer, static_cast<const btStaticPlaneShape&>(shape));
    default:
      return;
  }
}

/// Adds the parts of a convex shape, where its furthest points could hide a change.
void addConvexParts(KeyMixer& mixer, const btConvexShape& shape) {
  if (shape.getShapeType() == MULTI_SPHERE_SHAPE_PROXYTYPE) {
    const auto& spheres = static_cast<const btMultiSphereShape&>(shape);
    for (int i = 0; i < spheres.getSphereCount(); ++i) {
      mixer.add(spheres.getSpherePosition(i));
      mixer.add(spheres.getSphereRadius(i));
    }
  } else if (shape.getShapeType() == UNIFORM_SCALING_SHAPE_PROXYTYPE) {
    mixer.add(computeShapeKey(*static_cast<const btUniformScalingShape&>(shape).getChildShape()));
  } else if (shape.getShapeType() == CONVEX_2D_SHAPE_PROXYTYPE) {
    mixer.add(computeShapeKey(*static_cast<const btConvex2dShape&>(shape).getChildShape()));
  }
}

/// Adds a hull's points, or a simple shape's furthest points: any size and axis changes those.
void addConvex(KeyMixer& mixer, const btConvexShape& shape) {
  static const std::array<btVector3, 26> kDirections = makeCubeDirections();
  if (const auto points = findHullPoints(shape)) {
    for (const btVector3& point : *points) mixer.add(point);
    return;
  }
  addConvexParts(mixer, shape);
  for (const btVector3& direction : kDirections) {
    mixer.add(shape.localGetSupportingVertex(direction));
  }
}

void addBounds(KeyMixer& mixer, const btCollisionShape& shape) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  mixer.add(low);
  mixer.add(high);
}

}  // namespace

std::uint64_t computeShapeKey(const btCollisionShape& shape) {
  KeyMixer mixer;
  mixer.add(&shape);
  mixer.add(shape.getShapeType());
  mixer.add(shape.getLocalScaling());
  mixer.add(shape.getMargin());
  if (shape.isConvex()) {
    addConvex(mixer, static_cast<const btConvexShape&>(shape));
  } else if (shape.isConcave()) {
    addBounds(mixer, shape);
    addConcave(mixer, shape);
  } else if (shape.isCompound()) {
    addChildren(mixer, static_cast<const btCompoundShape&>(shape));
  }
  return mixer.key();
}

}  // namespace tandem::view
