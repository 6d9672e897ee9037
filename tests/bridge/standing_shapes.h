#pragma once

#include <functional>
#include <string>
#include <vector>

#include <BulletCollision/CollisionShapes/btBox2dShape.h>
#include <BulletCollision/CollisionShapes/btConvex2dShape.h>
#include <BulletCollision/CollisionShapes/btConvexPointCloudShape.h>
#include <BulletCollision/CollisionShapes/btConvexTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <BulletCollision/CollisionShapes/btMinkowskiSumShape.h>
#include <BulletCollision/CollisionShapes/btMultimaterialTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btScaledBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTetrahedronShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "bridge/bullet_rig.h"
#include "support/solids.h"

namespace tandem::test {

/// Shapes of Bullet about 4 cm large, and what they refer to.
class StandingShapes {
 public:
  explicit StandingShapes(BulletRig& rig) : rig_(rig) {}

  btCollisionShape& makeHull(const std::vector<Vec3>& points, double margin) {
    auto& hull = rig_.makeShape<btConvexHullShape>();
    for (const Vec3& p : points) hull.addPoint(toBullet(p));
    return setMargin(hull, margin);
  }
  btCollisionShape& makeSpheres(const std::vector<Vec3>& centres,
                                const std::vector<double>& radii) {
    std::vector<btVector3> places;
    for (const Vec3& p : centres) places.push_back(toBullet(p));
    const std::vector<btScalar> sizes(radii.begin(), radii.end());
    return setMargin(rig_.makeShape<btMultiSphereShape>(places.data(), sizes.data(),
                                                        static_cast<int>(places.size())),
                     0.004);
  }
  btConvexShape& makeSharpHull() {
    return static_cast<btConvexShape&>(makeHull(makeOctahedron({0.02, 0.03, 0.02}).corners, 0.001));
  }
  btTriangleMesh& makeTriangles(const Vec3& half) {
    const std::vector<Vec3> corners = cutIntoTriangles(makeBoxSolid(half));
    for (std::size_t i = 0; i < corners.size(); i += 3)
      triangles_.addTriangle(toBullet(corners[i]), toBullet(corners[i + 1]),
                             toBullet(corners[i + 2]));
    return triangles_;
  }
  btCollisionShape& makeTriangle() {
    return setMargin(rig_.makeShape<btTriangleShape>(toBullet(Vec3(-0.03, 0.0, -0.02)),
                                                     toBullet(Vec3(0.03, 0.0, -0.02)),
                                                     toBullet(Vec3(0.0, 0.0, 0.04))),
                     0.002);
  }
  btCollisionShape& makeCloud() {
    for (const Vec3& p : makeOctahedron({0.01, 0.015, 0.01}).corners) cloud_.push_back(toBullet(p));
    return setMargin(rig_.makeShape<btConvexPointCloudShape>(
                         cloud_.data(), static_cast<int>(cloud_.size()), btVector3(2, 2, 2)),
                     0.002);
  }
  btCollisionShape& makeMinkowskiSum() {
    auto& cone = rig_.makeShape<btConeShape>(btScalar(0.01), btScalar(0.02));
    cone.setMargin(btScalar(0.001));
    auto& sum = rig_.makeShape<btMinkowskiSumShape>(&makeSharpHull(), &cone);
    sum.setTransformA(toBullet(Vec3(0.002, 0, 0), turn(0.3, Vec3(1, 2, 0))));
    return sum;
  }
  btCollisionShape& makeField() {
    heights_.assign(25, btScalar(0.02));
    return rig_.makeShape<btHeightfieldTerrainShape>(
        5, 5, heights_.data(), btScalar(1), btScalar(-0.02), btScalar(0.02), 1, PHY_FLOAT, false);
  }
  btCollisionShape& makeGImpactMesh() {
    auto& mesh = rig_.makeShape<btGImpactMeshShape>(&makeTriangles({0.02, 0.01, 0.02}));
    mesh.setLocalScaling(btVector3(1, 2, 1));
    mesh.setMargin(btScalar(0.001));
    mesh.updateBound();
    return mesh;
  }
  btCollisionShape& makeGImpactCompound() {
    auto& compound = rig_.makeShape<btGImpactCompoundShape>();
    compound.addChildShape(toBullet(Vec3(0.0, 0.01, 0.0), Quat::Identity()),
                           &rig_.makeShape<btBoxShape>(toBullet(Vec3(0.02, 0.01, 0.02))));
    compound.updateBound();
    return compound;
  }

  template <typename ShapeType>
  static ShapeType& setMargin(ShapeType& shape, double margin) {
    shape.setMargin(static_cast<btScalar>(margin));
    return shape;
  }
  [[nodiscard]] BulletRig& rig() { return rig_; }

 private:
  BulletRig& rig_;
  btTriangleMesh triangles_;
  std::vector<btVector3> cloud_;
  std::vector<btScalar> heights_;
};

/// A class of Bullet's shapes, by one of them.
struct StandingShape {
  std::string name;
  std::function<btCollisionShape&(StandingShapes&)> make;
  double accuracy;  ///< by which the island's surface may differ from Bullet's [m]
};

/// Every convex class that has no tests of its own.
inline std::vector<StandingShape> listConvexShapes() {
  using In = StandingShapes&;
  using Out = btCollisionShape&;
  // Edges of Bullet's cylinders and boxes are rounded by the margin, those of the island are sharp.
  constexpr double kSmallMargin = 1e-5;
  constexpr double kRounding = 1e-9, kThickness = 2e-5, kSampled = 2e-4;
  return {
      {"Cone",
       [](In in) -> Out {
         auto& cone = in.rig().makeShape<btConeShapeZ>(btScalar(0.02), btScalar(0.04));
         return in.setMargin(cone, 0.002);
       },
       kRounding},
      {"OvalCylinder",
       [](In in) -> Out {
         auto& bar = in.rig().makeShape<btCylinderShape>(toBullet(Vec3(0.02, 0.03, 0.025)));
         return in.setMargin(bar, kSmallMargin);
       },
       kSmallMargin},
      {"EqualSpheres",
       [](In in) -> Out {
         return in.makeSpheres({{0.02, 0, 0}, {-0.02, 0, 0}, {0, 0.01, 0.01}, {0, 0, -0.02}},
                               {0.01, 0.01, 0.01, 0.01});
       },
       kRounding},
      {"EqualSpheresScaled",
       [](In in) -> Out {
         Out spheres =
             in.makeSpheres({{0.01, 0, 0}, {-0.01, 0, 0}, {0, 0.01, 0.01}}, {0.01, 0.01, 0.01});
         spheres.setLocalScaling(btVector3(2, 2, 2));
         return spheres;
       },
       kThickness},
      {"TwoSpheres",
       [](In in) -> Out {
         return in.makeSpheres({{0.02, 0, 0}, {-0.01, 0.01, 0}}, {0.01, 0.01});
       },
       kThickness},
      {"OneSphere",
       [](In in) -> Out {
         return in.makeSpheres({{0.005, 0.01, 0}}, {0.02});
       },
       kThickness},
      {"UnequalSpheres",
       [](In in) -> Out {
         return in.makeSpheres({{0.02, 0, 0}, {-0.02, 0, 0}, {0, 0.02, 0}}, {0.01, 0.02, 0.005});
       },
       kSampled},
      {"Box2d",
       [](In in) -> Out {
         auto& box = in.rig().makeShape<btBox2dShape>(toBullet(Vec3(0.02, 0.03, 0.01)));
         in.setMargin(box, kSmallMargin);
         box.setLocalScaling(btVector3(1, btScalar(0.5), 1));
         return box;
       },
       kSmallMargin},
      {"Convex2d",
       [](In in) -> Out { return in.rig().makeShape<btConvex2dShape>(&in.makeSharpHull()); },
       kRounding},
      {"ScaledHull",
       [](In in) -> Out {
         return in.rig().makeShape<btUniformScalingShape>(&in.makeSharpHull(), btScalar(1.5));
       },
       kRounding},
      {"ScaledCone",
       [](In in) -> Out {
         auto& cone = in.rig().makeShape<btConeShape>(btScalar(0.01), btScalar(0.02));
         in.setMargin(cone, 0.001);
         return in.rig().makeShape<btUniformScalingShape>(&cone, btScalar(2));
       },
       kRounding},
      {"MinkowskiSum", [](In in) -> Out { return in.makeMinkowskiSum(); }, kSampled},
      {"PointCloud", [](In in) -> Out { return in.makeCloud(); }, kRounding},
      {"Triangle", [](In in) -> Out { return in.makeTriangle(); }, kThickness},
      {"Tetrahedron",
       [](In in) -> Out {
         auto& corners = in.rig().makeShape<btBU_Simplex1to4>(
             toBullet(Vec3(0.03, 0, 0)), toBullet(Vec3(-0.02, 0, 0.02)),
             toBullet(Vec3(-0.02, 0, -0.02)), toBullet(Vec3(0, 0.03, 0)));
         return in.setMargin(corners, 0.002);
       },
       kRounding},
      {"ConvexTriangleMesh",
       [](In in) -> Out {
         auto& mesh =
             in.rig().makeShape<btConvexTriangleMeshShape>(&in.makeTriangles({0.02, 0.01, 0.03}));
         mesh.setLocalScaling(btVector3(1, 2, 1));
         return in.setMargin(mesh, 0.001);
       },
       kRounding},
      {"FlatHull",
       [](In in) -> Out {
         return in.makeHull(
             {{0.03, 0, 0.03}, {-0.03, 0, 0.03}, {-0.03, 0, -0.03}, {0.03, 0, -0.03}}, 0.001);
       },
       kThickness},
      {"NeedleHull",
       [](In in) -> Out {
         return in.makeHull({{0.03, 0, 0}, {0, 0.01, 0}, {-0.03, 0.02, 0}}, 0.005);
       },
       kThickness},
  };
}

/// A shape that is flat on top, at this height.
struct FlatTop {
  std::string name;
  std::function<btCollisionShape&(StandingShapes&)> make;
  double height;  ///< [m]
};

/// Every concave class that tells its triangles, and compounds.
inline std::vector<FlatTop> listFlatTops() {
  using In = StandingShapes&;
  using Out = btCollisionShape&;
  const Vec3 half(0.02, 0.01, 0.02);
  return {
      {"TriangleMesh",
       [half](In in) -> Out {
         auto& mesh = in.rig().makeShape<btBvhTriangleMeshShape>(&in.makeTriangles(half), true);
         return in.setMargin(mesh, 0.001);
       },
       0.011},
      {"ScaledTriangleMesh",
       [half](In in) -> Out {
         auto& mesh = in.rig().makeShape<btBvhTriangleMeshShape>(&in.makeTriangles(half), true);
         return in.rig().makeShape<btScaledBvhTriangleMeshShape>(&mesh, btVector3(1, 2, 1));
       },
       0.02},
      {"MultimaterialTriangleMesh",
       [half](In in) -> Out {
         auto& mesh =
             in.rig().makeShape<btMultimaterialTriangleMeshShape>(&in.makeTriangles(half), true);
         return in.setMargin(mesh, 0.002);
       },
       0.012},
      {"HeightField", [](In in) -> Out { return in.makeField(); }, 0.02},
      {"GImpactMesh", [](In in) -> Out { return in.makeGImpactMesh(); }, 0.021},
      {"GImpactCompound", [](In in) -> Out { return in.makeGImpactCompound(); }, 0.02},
  };
}

}  // namespace tandem::test
