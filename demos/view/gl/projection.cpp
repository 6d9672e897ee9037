#include "gl/projection.h"

#include <cmath>

namespace tandem::view {
namespace {

// Shares of the eye's distance, and the depth that even a close eye sees [m].
constexpr double kNearest = 0.02, kFarthest = 50.0, kFarAtLeast = 10.0;

double farthestDepth(const Eye& eye) { return kFarthest * eye.distance + kFarAtLeast; }

// Half the picture's height at a depth of one.
double halfHeight(const Eye& eye) { return std::tan(0.5 * eye.field_of_view); }

}  // namespace

double nearestDepth(const Eye& eye) { return kNearest * eye.distance; }

bool isUsable(const Eye& eye) noexcept {
  return eye.target_W.allFinite() && std::isfinite(eye.distance) && eye.distance > 0.0 &&
         std::isfinite(eye.azimuth) && std::isfinite(eye.elevation) && eye.field_of_view > 0.0 &&
         eye.field_of_view < 3.1;
}

EyeAxes computeEyeAxes(const Eye& eye) {
  const double cos_a = std::cos(eye.azimuth), sin_a = std::sin(eye.azimuth);
  const double cos_e = std::cos(eye.elevation), sin_e = std::sin(eye.elevation);
  return {.right_W = {-sin_a, cos_a, 0.0},
          .up_W = {-sin_e * cos_a, -sin_e * sin_a, cos_e},
          .back_W = {cos_e * cos_a, cos_e * sin_a, sin_e}};
}

Vec3 computeEyePosition(const Eye& eye) {
  return eye.target_W + eye.distance * computeEyeAxes(eye).back_W;
}

Mat4 computeViewMatrix(const Eye& eye) {
  const EyeAxes axes = computeEyeAxes(eye);
  Mat4 view = Mat4::Identity();
  view.row(0).head<3>() = axes.right_W;
  view.row(1).head<3>() = axes.up_W;
  view.row(2).head<3>() = axes.back_W;
  view.col(3).head<3>() = -view.topLeftCorner<3, 3>() * computeEyePosition(eye);
  return view;
}

Mat4 computeProjectionMatrix(const Eye& eye, PictureSize size) {
  const double nearest = nearestDepth(eye), farthest = farthestDepth(eye);
  const double scale = 1.0 / halfHeight(eye);
  Mat4 projection = Mat4::Zero();
  projection(0, 0) = scale / size.aspect();
  projection(1, 1) = scale;
  projection(2, 2) = -(farthest + nearest) / (farthest - nearest);
  projection(2, 3) = -2.0 * farthest * nearest / (farthest - nearest);
  projection(3, 2) = -1.0;
  return projection;
}

Mat4 computeWorldToClip(const Eye& eye, PictureSize size) {
  return computeProjectionMatrix(eye, size) * computeViewMatrix(eye);
}

std::optional<PointerRay> computeRay(const Eye& eye, PictureSize size, PicturePoint point) {
  if (size.isEmpty() || !isUsable(eye) || !std::isfinite(point.x) || !std::isfinite(point.y))
    return std::nullopt;
  const double half = halfHeight(eye);
  const double right = (2.0 * point.x / size.width - 1.0) * half * size.aspect();
  const double up = (1.0 - 2.0 * point.y / size.height) * half;
  const EyeAxes axes = computeEyeAxes(eye);
  const Vec3 d_W = right * axes.right_W + up * axes.up_W - axes.back_W;
  return PointerRay{.eye_W = computeEyePosition(eye), .direction_W = d_W.stableNormalized()};
}

std::optional<ProjectedPoint> projectPoint(const Eye& eye, PictureSize size, const Vec3& p_W) {
  if (size.isEmpty() || !isUsable(eye) || !p_W.allFinite()) return std::nullopt;
  const EyeAxes axes = computeEyeAxes(eye);
  const Vec3 from_eye = p_W - computeEyePosition(eye);
  const double depth = -axes.back_W.dot(from_eye);
  // The negation also refuses a point so far away that the depth is not a number.
  if (!(depth >= nearestDepth(eye))) return std::nullopt;
  const double per_half = 1.0 / (depth * halfHeight(eye));
  const double right = axes.right_W.dot(from_eye) * per_half / size.aspect();
  const double up = axes.up_W.dot(from_eye) * per_half;
  const PicturePoint point = {.x = 0.5 * (1.0 + right) * size.width,
                              .y = 0.5 * (1.0 - up) * size.height};
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) return std::nullopt;
  return ProjectedPoint{.point = point, .depth = depth};
}

}  // namespace tandem::view
