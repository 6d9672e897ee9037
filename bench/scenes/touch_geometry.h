#pragma once

#include "bench/scenes/bench_scene.h"

namespace tandem::demos::bench {

/// Contact of a sphere with a body.
struct Touch {
  double overlap = 0.0;           ///< positive while they overlap [m]
  Vec3 normal_W = Vec3::UnitX();  ///< points from the body towards the sphere
  Vec3 p_W = Vec3::Zero();        ///< point of the body's surface nearest to the sphere's centre
};

/// Nearest point of a body at `pose`: on a face, an edge or a corner of a box. For a centre inside
/// a box it is the nearest point of the nearest face.
[[nodiscard]] Touch computeTouch(const BenchBody& body, const RigidState& pose, const Vec3& p_W,
                                 double radius);

/// Force on the sphere [N]: max(0, K overlap + B overlap') along the normal while they overlap.
[[nodiscard]] Vec3 computeTouchForce(const CouplerGains& contact, const Touch& touch,
                                     const PointState& sphere, const RigidState& body);

}  // namespace tandem::demos::bench
