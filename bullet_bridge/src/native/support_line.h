#pragma once

#include "bodies/haptic_body.h"

namespace tandem {

/// A body at a contact, and where restore() or wakeIfHit() leave what Bullet's solver did to it.
/// Both null: the solver does not move it.
struct SupportBody {
  const HapticBody* bullet = nullptr;
  HostChange* change = nullptr;
  bool is_led = false;  ///< its host moves it on, whatever resists
};

/// One side of a line: a body, with its masses while Bullet's solver acts.
struct SupportSide {
  SupportBody body;
  double mass = 1.0;          ///< [kg]
  Vec3 arm_W = Vec3::Zero();  ///< from its centre [m]
  Quat q_WB = Quat::Identity();
  Vec3 inverse_mass = Vec3::Zero();  ///< along the axes of W [1/kg]
  /// Turn by an angular impulse: with angular factors, and without [1/(kg m^2)].
  Eigen::Matrix3d inverse_inertia_W = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d free_inverse_inertia_W = Eigen::Matrix3d::Zero();

  SupportSide() = default;
  SupportSide(const SupportBody& of, const Vec3& p_W);

  /// Velocity of the contact that Bullet's solver starts with [m/s].
  [[nodiscard]] Vec3 expect() const noexcept;
  /// Change of that velocity that the island has had already, and its contacts with it [m/s].
  [[nodiscard]] Vec3 foresee() const noexcept;
  /// Change of that velocity by the solver [m/s].
  [[nodiscard]] Vec3 computeChange() const noexcept;
  /// Inverse of the mass that an impulse along an axis moves [1/kg].
  [[nodiscard]] double computeInverseMass(const Vec3& along_W) const noexcept;
  /// The same without factors and turning [1/kg].
  [[nodiscard]] double freeInverseMass() const noexcept { return body.bullet ? 1.0 / mass : 0.0; }
  /// Adds an impulse [N s] to the change, and the way over `dt` [s] that it leads to.
  void give(const Vec3& j_W, double dt) const noexcept;
  [[nodiscard]] Momentum computeMomentum(const Vec3& j_W) const noexcept {
    return {j_W, arm_W.cross(j_W)};
  }
};

/// A contact of two bodies along one axis, and the impulse there in a step of the host.
struct SupportLine {
  SupportLine(const SupportBody& body_a, const SupportBody& body_b, const Vec3& p_W,
              const Vec3& along, double free);

  /// Relative velocity along the axis that Bullet's solver starts with [m/s].
  [[nodiscard]] double expect() const noexcept { return along_W.dot(a.expect() - b.expect()); }
  /// The same of what the island has had already [m/s].
  [[nodiscard]] double foresee() const noexcept { return along_W.dot(a.foresee() - b.foresee()); }
  /// One step of a sweep: changes the impulse within limits [N s] until the axis holds. Returns the
  /// size of the change.
  double improve(double least, double most, double dt) noexcept;

  SupportSide a, b;
  Vec3 along_W;         ///< impulses along it push a
  double free_speed;    ///< change of velocity along it that meets no resistance [m/s]
  double inverse_mass;  ///< of both along it; 0: their factors lock it [1/kg]
  double impulse = 0;   ///< on a [N s]
};

}  // namespace tandem
