#include "gl/eye_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tandem::view {
namespace {

double clampOr(double otherwise, double value, double low, double high) {
  return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

}  // namespace

Eye limitEye(const Eye& eye) {
  const Eye fresh;
  Eye limited;
  for (int axis = 0; axis < 3; ++axis)
    limited.target_W[axis] =
        clampOr(fresh.target_W[axis], eye.target_W[axis], -kFarthestTarget, kFarthestTarget);
  limited.distance = clampOr(fresh.distance, eye.distance, kNearestEye, kFarthestEye);
  limited.azimuth = std::isfinite(eye.azimuth) ? std::remainder(eye.azimuth, 2.0 * std::numbers::pi)
                                               : fresh.azimuth;
  limited.elevation = clampOr(fresh.elevation, eye.elevation, -kSteepestEye, kSteepestEye);
  limited.field_of_view = clampOr(fresh.field_of_view, eye.field_of_view, 0.1, 2.0);
  return limited;
}

Eye orbitEye(const Eye& eye, double azimuth, double elevation) {
  Eye turned = limitEye(eye);
  if (!std::isfinite(azimuth) || !std::isfinite(elevation)) return turned;
  turned.azimuth += azimuth;
  turned.elevation += elevation;
  return limitEye(turned);
}

Eye panEye(const Eye& eye, PictureSize size, double right, double down) {
  Eye moved = limitEye(eye);
  if (size.isEmpty() || !std::isfinite(right) || !std::isfinite(down)) return moved;
  const EyeAxes axes = computeEyeAxes(moved);
  const double pixel = 2.0 * moved.distance * std::tan(0.5 * moved.field_of_view) / size.height;
  moved.target_W += pixel * (down * axes.up_W - right * axes.right_W);
  return limitEye(moved);
}

Eye zoomEye(const Eye& eye, double factor) {
  Eye moved = limitEye(eye);
  if (!std::isfinite(factor) || factor <= 0.0) return moved;
  moved.distance *= factor;
  return limitEye(moved);
}

}  // namespace tandem::view
