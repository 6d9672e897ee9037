#include "gl/shadow_frame.h"

#include <algorithm>
#include <cmath>

namespace tandem::view {
namespace {

constexpr double kReach = 1.5;  // shadows farther from the target are left out [eye distances]
constexpr double kMargin = 1.05;

struct Interval {
  double low = 0.0, high = 0.0;

  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  [[nodiscard]] double length() const { return high - low; }
};

// Shadow of all casters on an axis.
Interval project(const std::vector<BoundingBall>& casters, const Vec3& axis) {
  if (casters.empty()) return {};
  Interval all = {.low = 1e30, .high = -1e30};
  for (const BoundingBall& ball : casters) {
    all.low = std::min(all.low, axis.dot(ball.p_W) - ball.radius);
    all.high = std::max(all.high, axis.dot(ball.p_W) + ball.radius);
  }
  return all;
}

// The part within the reach of the target.
Interval limit(const Interval& interval, double target, double reach) {
  return {.low = std::clamp(interval.low, target - reach, target + reach),
          .high = std::clamp(interval.high, target - reach, target + reach)};
}

// The next power of the fourth root of two.
double stepUp(double length) { return std::exp2(0.25 * std::ceil(4.0 * std::log2(length))); }

}  // namespace

Vec3 sunDirection() { return Vec3(-0.36, -0.42, 0.95).normalized(); }

ShadowFrame computeShadowFrame(const std::vector<BoundingBall>& casters, const Eye& eye,
                               int resolution) {
  const Vec3 towards = sunDirection();
  const Vec3 right = Vec3::UnitZ().cross(towards).normalized();
  const Vec3 up = towards.cross(right);
  const double reach = kReach * eye.distance;
  const Interval x = limit(project(casters, right), right.dot(eye.target_W), reach);
  const Interval y = limit(project(casters, up), up.dot(eye.target_W), reach);
  const Interval depth = project(casters, towards);

  const double side = stepUp(kMargin * std::max({x.length(), y.length(), 1e-3}));
  const double texel = side / resolution;
  const double middle_x = std::round(x.middle() / texel) * texel;
  const double middle_y = std::round(y.middle() / texel) * texel;
  const double half_depth = 0.5 * kMargin * depth.length() + texel;

  ShadowFrame frame{.world_to_clip = Mat4::Identity(), .texel = texel};
  Mat4& m = frame.world_to_clip;
  m.row(0) << 2.0 / side * right.transpose(), -2.0 / side * middle_x;
  m.row(1) << 2.0 / side * up.transpose(), -2.0 / side * middle_y;
  m.row(2) << -1.0 / half_depth * towards.transpose(), depth.middle() / half_depth;
  return frame;
}

}  // namespace tandem::view
