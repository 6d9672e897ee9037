#include "tandem/falcon/pointer_plane.h"

#include <cmath>

namespace tandem {
namespace {

constexpr double kLeastSlope = 0.05;    // |d . n| of a ray that is not nearly in the plane
constexpr double kNotch = 0.004;        // way of a notch [m] at
constexpr double kNotchDistance = 0.5;  // this distance from the eye [m]

std::optional<Vec3> within(const PointerReach& reach, const Vec3& target_W) noexcept {
  return reach.contains(target_W) ? std::optional(target_W) : std::nullopt;
}

}  // namespace

PointerPlane makeLevelPlane(const Vec3& target_W) noexcept { return {target_W, Vec3::UnitZ()}; }

std::optional<PointerPlane> makeUprightPlane(const Vec3& target_W, const Vec3& look_W) noexcept {
  const Vec3 look = look_W.stableNormalized();
  const Vec3 level(look.x(), look.y(), 0.0);
  const double size = level.norm();
  if (!(size >= kLeastSlope) || !std::isfinite(size)) return std::nullopt;
  return PointerPlane{target_W, level / size};
}

std::optional<Vec3> computePointerTarget(const PointerRay& ray, const PointerPlane& plane,
                                         const PointerReach& reach) noexcept {
  const Vec3 d = ray.direction_W.stableNormalized();
  const double slope = d.dot(plane.n_W);
  if (!(std::abs(slope) >= kLeastSlope)) return std::nullopt;
  const double way = plane.n_W.dot(plane.p_W - ray.eye_W) / slope;  // [m]
  if (!(way > 0.0)) return std::nullopt;                            // behind the eye
  return within(reach, ray.eye_W + way * d);
}

std::optional<Vec3> computeWheelTarget(const PointerPlane& plane, const Vec3& eye_W, double notches,
                                       const PointerReach& reach) noexcept {
  const double distance = (plane.p_W - eye_W).norm();
  const double way = notches * kNotch * distance / kNotchDistance;
  return within(reach, plane.p_W + way * plane.n_W);
}

}  // namespace tandem
