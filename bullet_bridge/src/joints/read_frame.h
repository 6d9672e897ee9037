#pragma once

#include <LinearMath/btTransform.h>

#include "tandem/bullet_bridge/convert.h"

#include "joints/joint_settings.h"

namespace tandem {

/// A joint's frame with axes at right angles; the `main` one keeps its direction. Hosts may give
/// axes that are not of unit length, and float ones are so only to 1e-7.
[[nodiscard]] inline JointFrame readFrame(const btTransform& frame, int main) noexcept {
  JointFrame out;
  out.p = fromBullet(frame.getOrigin());
  const int next = (main + 1) % 3;
  const Vec3 first = fromBullet(frame.getBasis().getColumn(main)).normalized();
  Vec3 second = fromBullet(frame.getBasis().getColumn(next));
  second = (second - first * first.dot(second)).normalized();
  out.axes.col(main) = first;
  out.axes.col(next) = second;
  out.axes.col((main + 2) % 3) = first.cross(second);
  return out;
}

}  // namespace tandem
