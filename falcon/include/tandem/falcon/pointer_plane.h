#pragma once

#include <optional>

#include "tandem/coordination/types.h"

/// \file
/// Turns a pointer on a picture into a target in the world. A pointer moves in two dimensions, so
/// it moves the target in a plane; its wheel moves the plane. Pure functions without a window.
#pragma GCC visibility push(default)
namespace tandem {

/// Ball of the targets that a pointer may have.
struct PointerReach {
  Vec3 centre_W = Vec3::Zero();  ///< [m]
  double radius = 0.4;           ///< [m], > 0

  /// False also for a point that is not finite.
  [[nodiscard]] bool contains(const Vec3& p_W) const noexcept {
    return (p_W - centre_W).norm() <= radius;
  }
};

/// Half line from the picture's eye through the pointer, in W.
struct PointerRay {
  Vec3 eye_W = Vec3::Zero();          ///< [m]
  Vec3 direction_W = -Vec3::UnitZ();  ///< of any length above 0
};

/// Plane in which a pointer moves the target, in W.
struct PointerPlane {
  Vec3 p_W = Vec3::Zero();   ///< a point of the plane: the present target [m]
  Vec3 n_W = Vec3::UnitZ();  ///< unit normal; the wheel moves the target along it
};

/// The level plane through `target_W`; its normal is W's z, up. The usual plane.
[[nodiscard]] PointerPlane makeLevelPlane(const Vec3& target_W) noexcept;

/// The upright plane through `target_W` that faces an eye which looks along `look_W`. Its normal is
/// the level part of `look_W`, away from the eye. It depends on the direction of the camera only,
/// so a pointer that comes back brings the target back. Empty if the eye looks down or up, within
/// 3 degrees, or if `look_W` is zero or not finite.
[[nodiscard]] std::optional<PointerPlane> makeUprightPlane(const Vec3& target_W,
                                                           const Vec3& look_W) noexcept;

/// Target under the pointer: where the ray meets the plane [m]. Empty if
///
///   - the ray is nearly in the plane, |d . n| < 0.05 with the unit direction d: a pixel would be
///     more than 20 times as far there as in a plane that faces the ray,
///   - the plane is behind the eye,
///   - the target is out of reach or not finite.
[[nodiscard]] std::optional<Vec3> computePointerTarget(const PointerRay& ray,
                                                       const PointerPlane& plane,
                                                       const PointerReach& reach) noexcept;

/// Target after `notches` of the wheel, along the normal from the plane's point [m]. A notch is 4
/// mm at 0.5 m from the eye, and in proportion to the distance elsewhere, so that it looks the
/// same. Empty if the target is out of reach or not finite.
[[nodiscard]] std::optional<Vec3> computeWheelTarget(const PointerPlane& plane, const Vec3& eye_W,
                                                     double notches,
                                                     const PointerReach& reach) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
