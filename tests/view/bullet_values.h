#pragma once

#include <LinearMath/btVector3.h>

namespace tandem::test {

/// A vector of Bullet, whose numbers may be float.
inline btVector3 vec(double x, double y, double z) {
  return {static_cast<btScalar>(x), static_cast<btScalar>(y), static_cast<btScalar>(z)};
}

}  // namespace tandem::test
