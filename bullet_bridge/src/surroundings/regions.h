#pragma once

#include <vector>

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "bodies/equal_bits.h"

namespace tandem {

/// An axis-aligned box.
struct Region {
  btVector3 low;
  btVector3 high;

  bool operator==(const Region& other) const noexcept {
    return equalBits(low, other.low) && equalBits(high, other.high);
  }
};

[[nodiscard]] inline Region growRegion(const Region& region, btScalar by) noexcept {
  const btVector3 skin(by, by, by);
  return {region.low - skin, region.high + skin};
}

[[nodiscard]] inline bool overlap(const Region& a, const Region& b) noexcept {
  return a.low.x() <= b.high.x() && a.high.x() >= b.low.x() && a.low.y() <= b.high.y() &&
         a.high.y() >= b.low.y() && a.low.z() <= b.high.z() && a.high.z() >= b.low.z();
}

[[nodiscard]] inline bool contains(const Region& outer, const Region& inner) noexcept {
  return outer.low.x() <= inner.low.x() && outer.high.x() >= inner.high.x() &&
         outer.low.y() <= inner.low.y() && outer.high.y() >= inner.high.y() &&
         outer.low.z() <= inner.low.z() && outer.high.z() >= inner.high.z();
}

/// Contains nothing.
inline const Region kNoRegion{btVector3(1, 1, 1), btVector3(-1, -1, -1)};

/// Box around a box at a pose.
[[nodiscard]] inline Region moveRegion(const Region& region, const btTransform& pose) noexcept {
  const btVector3 half = (region.high - region.low) * btScalar(0.5);
  const btVector3 centre = pose((region.low + region.high) * btScalar(0.5));
  const btMatrix3x3 turn = pose.getBasis().absolute();
  const btVector3 reach(turn[0].dot(half), turn[1].dot(half), turn[2].dot(half));
  return {centre - reach, centre + reach};
}

/// Bounding box of a shape at a pose; all of space for a plane.
[[nodiscard]] inline Region computeRegion(const btCollisionShape& shape,
                                          const btTransform& pose) noexcept {
  Region region;
  shape.getAabb(pose, region.low, region.high);
  return region;
}

/// True if a plane's half-space reaches into the region. Bullet's bounds of a plane are all of
/// space, so every floor would be near everything.
[[nodiscard]] inline bool reaches(const btStaticPlaneShape& plane, const btTransform& pose,
                                  const Region& region) noexcept {
  const btVector3 normal = pose.getBasis() * plane.getPlaneNormal();
  const btVector3 centre = (region.low + region.high) * btScalar(0.5);
  const btVector3 half = (region.high - region.low) * btScalar(0.5);
  const btScalar height = normal.dot(centre - pose.getOrigin()) - plane.getPlaneConstant();
  return height <= normal.absolute().dot(half);
}

/// True if a shape at a pose, bounded by `bounds`, may reach into the region.
[[nodiscard]] inline bool mayReach(const btCollisionShape& shape, const btTransform& pose,
                                   const Region& bounds, const Region& region) noexcept {
  if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE)
    return reaches(static_cast<const btStaticPlaneShape&>(shape), pose, region);
  return overlap(bounds, region);
}

}  // namespace tandem
