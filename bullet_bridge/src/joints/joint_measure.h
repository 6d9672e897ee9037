#pragma once

#include <array>
#include <cstdint>

#include "coordination/src/geometry/plain_vec.h"
#include "joints/joint_settings.h"

namespace tandem {

/// A joint's frames in W.
struct PlacedJoint {
  PlacedJoint(const JointSettings& joint, const RigidState& a, const RigidState& b) noexcept {
    place(joint.a, a, p_a, axes_a);
    place(joint.b, b, p_b, axes_b);
  }

  Vec3 p_a, p_b;
  Eigen::Matrix3d axes_a, axes_b;

 private:
  static void place(const JointFrame& frame, const RigidState& state, Vec3& p_W,
                    Eigen::Matrix3d& axes_W) noexcept {
    const PlainRotation R_WB(state.q_WB);
    p_W = state.p_W + R_WB.toWorld(PlainVec(frame.p)).toVec3();
    for (int i = 0; i < 3; ++i)
      R_WB.toWorld(PlainVec(frame.axes.data() + 3 * i)).store(axes_W.data() + 3 * i);
  }
};

/// A coordinate of a joint at given poses. Its direction is the exact gradient of `way`: along a
/// linear one, about an angular one. a gets it with this sign, and b with the other.
struct JointCoordinate {
  /// What its direction goes with.
  enum class Goes : std::uint8_t { kAlone, kWithWorld, kWithA };

  bool is_there = false, is_angular = false;
  Goes goes = Goes::kAlone;
  Vec3 direction_W;  ///< valid if it is there
  double way;        ///< [m or rad]; its rate is u

  void setWay(const Vec3& n_W, double its_way, Goes goes_with) noexcept {
    is_there = true;
    is_angular = false;
    goes = goes_with;
    direction_W = n_W;
    way = its_way;
  }
  void setAngle(const Vec3& axis_W, double angle, Goes goes_with = Goes::kAlone) noexcept {
    setWay(axis_W, angle, goes_with);
    is_angular = true;
  }
};

using JointCoordinates = std::array<JointCoordinate, 6>;

/// Measures the coordinates of a joint other than a gear, angles only of axes that act. Ways are
/// exact gradients where all locked coordinates are 0; elsewhere those of pins and tilts differ by
/// the error.
[[nodiscard]] JointCoordinates measureJoint(const JointSettings& joint,
                                            const PlacedJoint& placed) noexcept;

/// Measures twist (3) and swing (4, 5) of a cone twist joint.
void measureSwing(const JointSettings& joint, const PlacedJoint& placed,
                  JointCoordinates& out) noexcept;

/// Measures tilts (3, 4) and turn (5) of a multi-body's spherical joint.
void measureTiltTurn(const PlacedJoint& placed, JointCoordinates& out) noexcept;

}  // namespace tandem
