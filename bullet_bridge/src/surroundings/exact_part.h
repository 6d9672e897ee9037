#pragma once

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>

#include "tandem/bullet_bridge/convert.h"

#include "surroundings/private_copies.h"

namespace tandem {

/// A face of a part, in its frame: points p with normal . p = offset.
struct ExactFace {
  Vec3 normal = Vec3::UnitX();  ///< outward
  double offset = 0.0;          ///< [m]
};

/// A part of a private copy in double: the host's shape without skin, at a pose that no float has
/// rounded. Real-time safe.
struct ExactPart {
  [[nodiscard]] static ExactPart of(const PrivateCopy& copy, const Part& part) noexcept;

  [[nodiscard]] bool is(int shape_type) const noexcept {
    return shape->getShapeType() == shape_type;
  }
  /// Radius by which the shape is larger than the hull of its corners [m].
  [[nodiscard]] double rounding() const noexcept;
  /// Finds the face of a box or plane with this outward normal, in the frame of the part, but for
  /// `tolerance` [rad]. False if there is none.
  [[nodiscard]] bool findFace(const Vec3& normal, double tolerance, ExactFace& face) const noexcept;
  /// Calls `visit` for each corner, in the frame of the part. A ball has one, a capsule two. False
  /// if the shape has none, or too many to look through.
  template <typename Visit>
  bool visitCorners(Visit visit) const noexcept;

  const btCollisionShape* shape;
  Vec3 half;                     ///< half extents of a box [m]
  double skin;                   ///< excess of `shape` over the host's, all round [m]
  const btTransform* in_object;  ///< pose in its object; null: the same
  Eigen::Matrix3d axes;          ///< of the part
  Vec3 p;                        ///< its origin, from the private origin [m]

  static constexpr int kMostCorners = 256;
};

template <typename Visit>
bool ExactPart::visitCorners(Visit visit) const noexcept {
  switch (shape->getShapeType()) {
    case BOX_SHAPE_PROXYTYPE: {
      for (int i = 0; i < 8; ++i)
        visit(Vec3(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(),
                   i & 4 ? half.z() : -half.z()));
      return true;
    }
    case SPHERE_SHAPE_PROXYTYPE:
      visit(Vec3(Vec3::Zero()));
      return true;
    case CAPSULE_SHAPE_PROXYTYPE: {
      const auto& capsule = static_cast<const btCapsuleShape&>(*shape);
      Vec3 end = Vec3::Zero();
      end[capsule.getUpAxis()] = static_cast<double>(capsule.getHalfHeight());
      visit(end);
      visit(Vec3(-end));
      return true;
    }
    case CONVEX_HULL_SHAPE_PROXYTYPE: {
      const auto& hull = static_cast<const btConvexHullShape&>(*shape);
      if (hull.getNumPoints() > kMostCorners) return false;
      for (int i = 0; i < hull.getNumPoints(); ++i) visit(fromBullet(hull.getScaledPoint(i)));
      return true;
    }
    default:
      return false;
  }
}

}  // namespace tandem
