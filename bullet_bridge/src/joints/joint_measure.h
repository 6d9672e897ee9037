#pragma once

#include <array>

#include "joints/joint_settings.h"

namespace tandem {

/// A joint's frames in W.
struct PlacedJoint {
  PlacedJoint(const JointSettings& joint, const RigidState& state_a, const RigidState& state_b)
      : p_a(state_a.p_W + state_a.q_WB * joint.a.p),
        p_b(state_b.p_W + state_b.q_WB * joint.b.p),
        axes_a(state_a.q_WB.toRotationMatrix() * joint.a.axes),
        axes_b(state_b.q_WB.toRotationMatrix() * joint.b.axes) {}

  Vec3 p_a, p_b;
  Eigen::Matrix3d axes_a, axes_b;
};

/// A coordinate of a joint at given poses. Linear ones have n, angular ones `turn`: the
/// exact gradient of `way`, which a gets with this sign, and b with the other.
struct JointCoordinate {
  bool is_there = false;
  Vec3 n_W = Vec3::Zero();
  Vec3 turn_W = Vec3::Zero();
  double way = 0.0;  ///< [m or rad]; its rate is u

  void setAngle(const Vec3& axis_W, double angle) noexcept {
    is_there = true;
    turn_W = axis_W;
    way = angle;
  }
};

using JointCoordinates = std::array<JointCoordinate, 6>;

/// Measures the coordinates of a joint other than a gear. Ways are exact gradients where all
/// locked coordinates are 0; elsewhere those of pins and tilts differ by the error.
[[nodiscard]] JointCoordinates measureJoint(const JointSettings& joint,
                                            const PlacedJoint& placed) noexcept;

/// Measures twist (3) and swing (4, 5) of a cone twist joint.
void measureSwing(const JointSettings& joint, const PlacedJoint& placed,
                  JointCoordinates& out) noexcept;

}  // namespace tandem
