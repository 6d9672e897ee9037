#include "bench/scenes/touch_geometry.h"

#include <algorithm>
#include <cmath>

namespace tandem::demos::bench {
namespace {

struct Nearest {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitX();
  double distance = 0.0;  // distance of the centre from the surface, negative inside
};

Nearest findOnBox(const Vec3& h, const Vec3& p) {
  const Vec3 inside = p.cwiseMax(-h).cwiseMin(h);
  const double distance = (p - inside).norm();
  if (distance > 0.0) return {inside, (p - inside) / distance, distance};
  int axis = 0;
  const double depth = (h - p.cwiseAbs()).minCoeff(&axis);
  Nearest nearest{p, Vec3::Zero(), -depth};
  const double side = std::copysign(1.0, p[axis]);
  nearest.normal[axis] = side;
  nearest.point[axis] = side * h[axis];
  return nearest;
}

Nearest findNearest(const BenchBody& body, const Vec3& p_B, const Quat& q_WB) {
  if (const auto* box = std::get_if<BoxShape>(&body.shape))
    return findOnBox(box->half_extents, p_B);
  if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
    const double length = p_B.norm();
    const Vec3 normal = length > 0.0 ? Vec3(p_B / length) : Vec3::UnitX();
    return {sphere->radius * normal, normal, length - sphere->radius};
  }
  const Vec3 normal = q_WB.conjugate() * std::get<PlaneShape>(body.shape).normal_W;
  const double distance = normal.dot(p_B);
  return {p_B - distance * normal, normal, distance};
}

}  // namespace

Touch computeTouch(const BenchBody& body, const RigidState& pose, const Vec3& p_W, double radius) {
  const Nearest nearest = findNearest(body, pose.q_WB.conjugate() * (p_W - pose.p_W), pose.q_WB);
  return {radius - nearest.distance, pose.q_WB * nearest.normal,
          pose.p_W + pose.q_WB * nearest.point};
}

Vec3 computeTouchForce(const CouplerGains& contact, const Touch& touch, const PointState& sphere,
                       const RigidState& body) {
  if (touch.overlap <= 0.0) return Vec3::Zero();
  const Vec3 v_point_W = body.v_W + body.w_W.cross(touch.p_W - body.p_W);
  const double closing = -touch.normal_W.dot(sphere.v_W - v_point_W);
  return std::max(0.0, contact.stiffness * touch.overlap + contact.damping * closing) *
         touch.normal_W;
}

}  // namespace tandem::demos::bench
