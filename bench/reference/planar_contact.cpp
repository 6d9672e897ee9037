#include "bench/reference/planar_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace tandem::demos::bench {
namespace {

Vec2 turn(double angle, const Vec2& a) { return Eigen::Rotation2Dd(angle) * a; }

/// Corners in counterclockwise order; face i lies between corners i and i + 1.
struct Corners {
  std::array<Vec2, 4> p;
  std::array<Vec2, 4> normal;
};

Corners computeCorners(const PlanarBody& box) {
  const Vec2 x = turn(box.angle, {box.half.x(), 0.0});
  const Vec2 y = turn(box.angle, {0.0, box.half.y()});
  const Vec2 ex = x.normalized(), ey = y.normalized();
  return {{box.p - x - y, box.p + x - y, box.p + x + y, box.p - x + y}, {-ey, ex, ey, -ex}};
}

/// The face of `a` farthest from `b`, and its distance.
struct FaceGap {
  int face = 0;
  double gap = -std::numeric_limits<double>::infinity();
};

FaceGap findFace(const Corners& a, const Corners& b) {
  FaceGap best;
  for (int i = 0; i < 4; ++i) {
    double gap = std::numeric_limits<double>::infinity();
    for (const Vec2& corner : b.p)
      gap = std::min(gap, a.normal[static_cast<std::size_t>(i)].dot(
                              corner - a.p[static_cast<std::size_t>(i)]));
    if (gap > best.gap) best = {i, gap};
  }
  return best;
}

/// Points of the face of `b` most opposed to face `face` of `a`, cut to that face's width.
void clipFaces(const Corners& a, int face, const Corners& b, double reach, bool flipped,
               PlanarManifold& manifold) {
  const auto f = static_cast<std::size_t>(face);
  const Vec2 normal = a.normal[f];
  const Vec2 start = a.p[f], end = a.p[(f + 1) % 4];
  const Vec2 along = (end - start).normalized();
  std::size_t other = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (b.normal[i].dot(normal) < b.normal[other].dot(normal)) other = i;
  const Vec2 q0 = b.p[other], q1 = b.p[(other + 1) % 4];

  // Moves both ends of b's face along it to the ends of a's face.
  const double length = (end - start).norm();
  const double s0 = along.dot(q0 - start), s1 = along.dot(q1 - start);
  for (int k = 0; k < 2; ++k) {
    double s = k == 0 ? s0 : s1;
    const double clipped = std::clamp(s, 0.0, length);
    const double share = s0 == s1 ? static_cast<double>(k) : (clipped - s0) / (s1 - s0);
    if (share < 0.0 || share > 1.0) continue;
    const Vec2 q = q0 + share * (q1 - q0);
    const double gap = normal.dot(q - start);
    if (gap > reach) continue;
    manifold.points[static_cast<std::size_t>(manifold.count++)] = {
        q - 0.5 * gap * normal, gap,
        ((flipped ? 4 : 0) + face) * 16 + static_cast<int>(other) * 2 + k};
  }
  manifold.normal = flipped ? Vec2(-normal) : normal;
}

PlanarManifold meetBoxes(const PlanarBody& a, const PlanarBody& b, double reach) {
  PlanarManifold manifold;
  const Corners ca = computeCorners(a), cb = computeCorners(b);
  const FaceGap fa = findFace(ca, cb), fb = findFace(cb, ca);
  if (std::max(fa.gap, fb.gap) > reach) return manifold;
  // Rounding must not decide between equal faces, or the features would change from step to step.
  if (fa.gap >= fb.gap - 1e-9) {
    clipFaces(ca, fa.face, cb, reach, false, manifold);
  } else {
    clipFaces(cb, fb.face, ca, reach, true, manifold);
  }
  return manifold;
}

PlanarManifold meetHalfPlane(const PlanarBody& plane, const PlanarBody& box, double reach) {
  PlanarManifold manifold;
  manifold.normal = plane.normal;
  const Corners corners = computeCorners(box);
  for (int i = 0; i < 4 && manifold.count < 2; ++i) {
    const Vec2& corner = corners.p[static_cast<std::size_t>(i)];
    const double gap = plane.normal.dot(corner - plane.p);
    if (gap > reach) continue;
    manifold.points[static_cast<std::size_t>(manifold.count++)] = {
        corner - 0.5 * gap * plane.normal, gap, i};
  }
  return manifold;
}

/// Contact of `body` with `circle`, which is on the side of the normal.
PlanarManifold meetCircle(const PlanarBody& body, const PlanarBody& circle, double reach) {
  PlanarManifold manifold;
  const PlanarTouch touch = computePlanarTouch(body, circle.p, circle.radius);
  if (-touch.overlap > reach) return manifold;
  manifold.normal = touch.normal;
  manifold.points[0] = {touch.point - 0.5 * touch.overlap * touch.normal, -touch.overlap, 0};
  manifold.count = 1;
  return manifold;
}

PlanarManifold flip(PlanarManifold manifold) {
  manifold.normal = -manifold.normal;
  return manifold;
}

}  // namespace

PlanarManifold computeManifold(const PlanarBody& a, const PlanarBody& b, double reach) {
  if (b.shape == PlanarShape::kCircle) return meetCircle(a, b, reach);
  if (a.shape == PlanarShape::kCircle) return flip(meetCircle(b, a, reach));
  if (a.shape == PlanarShape::kHalfPlane && b.shape == PlanarShape::kHalfPlane) return {};
  if (a.shape == PlanarShape::kHalfPlane) return meetHalfPlane(a, b, reach);
  if (b.shape == PlanarShape::kHalfPlane) return flip(meetHalfPlane(b, a, reach));
  return meetBoxes(a, b, reach);
}

PlanarTouch computePlanarTouch(const PlanarBody& body, const Vec2& centre, double radius) {
  if (body.shape == PlanarShape::kHalfPlane) {
    const double distance = body.normal.dot(centre - body.p);
    return {radius - distance, body.normal, centre - distance * body.normal};
  }
  if (body.shape == PlanarShape::kCircle) {
    const double distance = (centre - body.p).norm();
    const Vec2 normal = distance > 0.0 ? Vec2((centre - body.p) / distance) : Vec2::UnitX();
    return {radius + body.radius - distance, normal, body.p + body.radius * normal};
  }
  const Vec2 local = turn(-body.angle, centre - body.p);
  const Vec2 inside = local.cwiseMax(-body.half).cwiseMin(body.half);
  const double distance = (local - inside).norm();
  Vec2 point = inside, normal;
  double gap = distance;
  if (distance > 0.0) {
    normal = (local - inside) / distance;
  } else {
    // The centre is inside: the normal points out through the nearest face.
    int axis = 0;
    gap = -(body.half - local.cwiseAbs()).minCoeff(&axis);
    normal = Vec2::Zero();
    normal[axis] = std::copysign(1.0, local[axis]);
    point[axis] = normal[axis] * body.half[axis];
  }
  return {radius - gap, turn(body.angle, normal), body.p + turn(body.angle, point)};
}

}  // namespace tandem::demos::bench
