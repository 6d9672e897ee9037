#pragma once

#include <LinearMath/btTransform.h>

#include "tandem/coordination/types.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Conversion between Bullet's btScalar and double; values for Bullet are rounded to btScalar.
[[nodiscard]] inline btVector3 toBullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}
[[nodiscard]] inline btQuaternion toBullet(const Quat& q) {
  return {static_cast<btScalar>(q.x()), static_cast<btScalar>(q.y()), static_cast<btScalar>(q.z()),
          static_cast<btScalar>(q.w())};
}
[[nodiscard]] inline Vec3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
[[nodiscard]] inline Quat fromBullet(const btQuaternion& q) {
  return Quat(q.w(), q.x(), q.y(), q.z()).normalized();
}
[[nodiscard]] inline btTransform toBullet(const Vec3& p_WB, const Quat& q_WB) {
  return btTransform(toBullet(q_WB), toBullet(p_WB));
}

}  // namespace tandem
#pragma GCC visibility pop
