#include "joints/joint_measure.h"

#include <algorithm>

namespace tandem {
namespace {

using Axes = Eigen::Matrix3d;
using Goes = JointCoordinate::Goes;

void measureLinear(const Vec3& n_W, Goes goes, const PlacedJoint& placed, JointCoordinate& out) {
  out.setWay(n_W, n_W.dot(placed.p_a - placed.p_b), goes);
}

/// Both points are one. World axes do not change between poses, so Newton's rows stay good.
void measurePin(const PlacedJoint& placed, JointCoordinates& out) {
  for (int i = 0; i < 3; ++i)
    measureLinear(Vec3::Unit(i), Goes::kWithWorld, placed, out[static_cast<std::size_t>(i)]);
}

/// Along the axes of a.
void measureShift(const PlacedJoint& placed, JointCoordinates& out) {
  for (int i = 0; i < 3; ++i)
    measureLinear(placed.axes_a.col(i), Goes::kWithA, placed, out[static_cast<std::size_t>(i)]);
}

/// Tilts of `main` of both frames against each other, about the other two axes of a.
void measureTilt(const PlacedJoint& placed, int main, JointCoordinate& first,
                 JointCoordinate& second) {
  const Vec3 error = placed.axes_a.col(main).cross(placed.axes_b.col(main));
  const int next = (main + 1) % 3, last = (main + 2) % 3;
  const Vec3 p = placed.axes_a.col(std::min(next, last)),
             q = placed.axes_a.col(std::max(next, last));
  first.setAngle(p, -p.dot(error), Goes::kWithA);
  second.setAngle(q, -q.dot(error), Goes::kWithA);
}

void measureHinge(const JointSettings& joint, const PlacedJoint& placed, JointCoordinates& out) {
  if (joint.holds_points) measurePin(placed, out);
  measureTilt(placed, 2, out[3], out[4]);
  if (!joint.axes[5].acts()) return;
  const Vec3 swing = placed.axes_b.col(1);
  const double angle = std::atan2(swing.dot(placed.axes_a.col(0)), swing.dot(placed.axes_a.col(1)));
  out[5].setAngle(placed.axes_a.col(2), angle, Goes::kWithA);
}

void measureSlider(const JointSettings& joint, const PlacedJoint& placed, JointCoordinates& out) {
  measureShift(placed, out);
  measureTilt(placed, 0, out[4], out[5]);
  if (!joint.axes[3].acts()) return;
  const Vec3 side = placed.axes_b.col(1);
  const double angle = std::atan2(side.dot(placed.axes_a.col(2)), side.dot(placed.axes_a.col(1)));
  out[3].setAngle(placed.axes_a.col(0), -angle, Goes::kWithA);
}

/// Euler angles of frame a in frame b, in turn about i, j and k: the axis i is of b, k of a, and
/// the axis j is at right angles to both. Where i and k fall into one, angles are not defined.
void measureEuler(const std::array<int, 3>& order, const PlacedJoint& placed,
                  JointCoordinates& out) {
  constexpr double kLeastSine = 1e-3;  // between i and k; bounds the gradient
  const auto [i, j, k] = order;
  const double sign = (i + 1) % 3 == j ? 1.0 : -1.0;
  const Axes m = placed.axes_b.transpose() * placed.axes_a;
  const double sine = std::clamp(sign * m(i, k), -1.0, 1.0);
  const double angle_i = std::atan2(-sign * m(j, k), m(k, k));
  const double angle_k = std::atan2(-sign * m(i, j), m(i, i));

  const Vec3 axis_i = placed.axes_b.col(i), axis_k = placed.axes_a.col(k);
  const Vec3 across = sign * axis_k.cross(axis_i);
  const double length = across.norm();
  const Vec3 axis_j = length > 1e-9 ? Vec3(across / length) : Vec3(axis_i.unitOrthogonal());
  const double scale = 1.0 / std::max(length, kLeastSine);
  const auto at = [&](int axis) -> JointCoordinate& {
    return out[static_cast<std::size_t>(axis + 3)];
  };
  at(i).setAngle(sign * scale * axis_j.cross(axis_k), angle_i);
  at(j).setAngle(axis_j, std::asin(sine));
  at(k).setAngle(sign * scale * axis_i.cross(axis_j), angle_k);
}

/// The turn of frame a beside frame b, about axes of a. Its rate is u about an axis that stays.
void measureTurn(const PlacedJoint& placed, JointCoordinates& out) {
  const Eigen::AngleAxisd turn(Axes(placed.axes_b.transpose() * placed.axes_a));
  for (int i = 0; i < 3; ++i)
    out[static_cast<std::size_t>(i + 3)].setAngle(placed.axes_a.col(i),
                                                  turn.angle() * turn.axis()[i], Goes::kWithA);
}

}  // namespace

JointCoordinates measureJoint(const JointSettings& joint, const PlacedJoint& placed) noexcept {
  JointCoordinates out;
  switch (joint.kind) {
    case JointKind::kPoint:
      measurePin(placed, out);
      break;
    case JointKind::kHinge:
      measureHinge(joint, placed, out);
      break;
    case JointKind::kSlider:
      measureSlider(joint, placed, out);
      break;
    case JointKind::kConeTwist:
      measurePin(placed, out);
      measureSwing(joint, placed, out);
      break;
    case JointKind::kSixDof:
      measureShift(placed, out);
      measureEuler(joint.order, placed, out);
      break;
    case JointKind::kGear:
      break;
    case JointKind::kWeld:
      if (joint.holds_points) measurePin(placed, out);
      measureTurn(placed, out);
      break;
    case JointKind::kRail:
      measureShift(placed, out);
      measureTurn(placed, out);
      break;
    case JointKind::kTiltTurn:
      measureTiltTurn(placed, out);
      break;
  }
  return out;
}

}  // namespace tandem
