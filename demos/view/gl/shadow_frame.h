#pragma once

#include <vector>

#include "gl/projection.h"

namespace tandem::view {

/// A ball that holds a body.
struct BoundingBall {
  Vec3 p_W = Vec3::Zero();
  double radius = 0.0;  ///< [m]
};

/// What the sun's picture of the shadows shows.
struct ShadowFrame {
  Mat4 world_to_clip = Mat4::Identity();
  double texel = 0.0;  ///< width of a pixel of it in the world [m]
};

/// Direction from the world to the sun: from the upper left behind an Eye as it is made.
[[nodiscard]] Vec3 sunDirection();

/// Fits the sun's picture of `resolution` x `resolution` to what casts shadows near the eye's
/// target. It moves by whole pixels and grows in steps, so that shadows keep still while bodies
/// move.
[[nodiscard]] ShadowFrame computeShadowFrame(const std::vector<BoundingBall>& casters,
                                             const Eye& eye, int resolution);

}  // namespace tandem::view
