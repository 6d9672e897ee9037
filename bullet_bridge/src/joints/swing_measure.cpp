#include <algorithm>
#include <cmath>

#include "joints/joint_measure.h"

namespace tandem {
namespace {

constexpr double kLeastTurn = 1e-9;  // directions of smaller ones are unknown [1]

/// The turn about x that is left when the shortest arc has brought both x axes together.
void measureTwist(const PlacedJoint& placed, JointCoordinate& out) {
  const Eigen::Matrix3d m = placed.axes_b.transpose() * placed.axes_a;
  const Vec3 both = placed.axes_a.col(0) + placed.axes_b.col(0);
  const double parts = 1.0 + m(0, 0);
  if (parts < kLeastTurn) return;
  const Quat q(m);
  out.setAngle(both / parts, std::remainder(2.0 * std::atan2(q.x(), q.w()), 2.0 * M_PI));
}

/// Way left to an elliptic cone about x of b. Its half angle towards phi, from y to z, is
///
///   L = 1 / sqrt((cos(phi) / span1)^2 + (sin(phi) / span2)^2)
void measureCone(const SwingSettings& swing, const PlacedJoint& placed, JointCoordinate& out) {
  const Vec3 c = placed.axes_b.transpose() * placed.axes_a.col(0);
  const double sine = std::hypot(c.y(), c.z());
  if (sine < kLeastTurn) return;
  const double theta = std::atan2(sine, c.x());
  const double cos_phi = c.y() / sine, sin_phi = c.z() / sine;
  const double tight1 = 1.0 / (swing.span1 * swing.span1);
  const double tight2 = 1.0 / (swing.span2 * swing.span2);
  const double limit = 1.0 / std::sqrt(cos_phi * cos_phi * tight1 + sin_phi * sin_phi * tight2);
  const double slope = -limit * limit * limit * sin_phi * cos_phi * (tight2 - tight1);

  // The way's gradient on the sphere of c, and from it that over turns: dc = w x c.
  const Vec3 along_theta(-sine, c.x() * cos_phi, c.x() * sin_phi);
  const Vec3 along_phi(0.0, -sin_phi, cos_phi);
  const Vec3 gradient = slope / sine * along_phi - along_theta;
  out.setAngle(placed.axes_b * c.cross(gradient), limit - theta);
}

/// Both swings are locked: x axes are one.
void measureFixed(const PlacedJoint& placed, JointCoordinates& out) {
  const Vec3 error = placed.axes_a.col(0).cross(placed.axes_b.col(0));
  for (const std::size_t i : {1u, 2u}) {
    const Vec3 axis = placed.axes_a.col(static_cast<int>(i));
    out[i + 3].setAngle(axis, -axis.dot(error), JointCoordinate::Goes::kWithA);
  }
}

/// Locks a single swing: x of b stays in the plane of x and `free` of a.
void measureFlat(const PlacedJoint& placed, int free, JointCoordinates& out) {
  const Vec3 x_b = placed.axes_b.col(0), x_a = placed.axes_a.col(0);
  const Vec3 out_of = placed.axes_a.col(3 - free), in = placed.axes_a.col(free);
  out[4].setAngle(out_of.cross(x_b), out_of.dot(x_b));
  const double x = x_b.dot(x_a), y = x_b.dot(in), square = x * x + y * y;
  if (square < kLeastTurn) return;
  out[5].setAngle((x * in.cross(x_b) - y * x_a.cross(x_b)) / square, std::atan2(y, x));
}

/// The turn of a that is left to the target.
void measureTarget(const SwingSettings& swing, const PlacedJoint& placed, JointCoordinate& out) {
  const Eigen::AngleAxisd left(
      Eigen::Matrix3d(placed.axes_b * swing.target * placed.axes_a.transpose()));
  if (left.angle() < kLeastTurn) return;
  out.setAngle(left.axis(), -left.angle());
}

}  // namespace

void measureSwing(const JointSettings& joint, const PlacedJoint& placed,
                  JointCoordinates& out) noexcept {
  if (!joint.axes[3].isFree()) measureTwist(placed, out[3]);
  switch (joint.swing.kind) {
    case SwingKind::kFree:
      break;
    case SwingKind::kCone:
      measureCone(joint.swing, placed, out[4]);
      break;
    case SwingKind::kFixed:
      measureFixed(placed, out);
      break;
    case SwingKind::kAboutZ:
      measureFlat(placed, 1, out);
      break;
    case SwingKind::kAboutY:
      measureFlat(placed, 2, out);
      break;
    case SwingKind::kMotor:
      measureTarget(joint.swing, placed, out[4]);
      break;
  }
}

/// With d, the axis z of a in frame b turned back by the turn psi about z:
///
///   tilt about x = atan2(-d_y, d_z),   tilt about y = asin(d_x)
///
/// Gradients over turns follow from c' = w x c and d' = Rz(-psi) c' - psi' z x d.
void measureTiltTurn(const PlacedJoint& placed, JointCoordinates& out) noexcept {
  const Eigen::Matrix3d m = placed.axes_b.transpose() * placed.axes_a;
  const Vec3 c = m.col(2), z = Vec3::UnitZ();
  const double parts = 1.0 + c.z();
  if (parts < kLeastTurn) return;
  const Quat q(m);
  const double psi = std::remainder(2.0 * std::atan2(q.z(), q.w()), 2.0 * M_PI);
  const Vec3 turn = (c + z) / parts;
  const Eigen::Matrix3d about_z = Eigen::AngleAxisd(psi, z).toRotationMatrix();
  const Vec3 d = about_z.transpose() * c;
  out[5].setAngle(placed.axes_b * turn, psi);
  const auto setTilt = [&](JointCoordinate& tilt, const Vec3& by_d, double angle) {
    const Vec3 gradient = c.cross(about_z * by_d) - by_d.dot(z.cross(d)) * turn;
    tilt.setAngle(placed.axes_b * gradient, angle);
  };
  const double about_x = d.y() * d.y() + d.z() * d.z();
  if (about_x < kLeastTurn) return;
  setTilt(out[3], Vec3(0.0, -d.z(), d.y()) / about_x, std::atan2(-d.y(), d.z()));
  setTilt(out[4], Vec3(1.0 / std::sqrt(about_x), 0.0, 0.0),
          std::asin(std::clamp(d.x(), -1.0, 1.0)));
}

}  // namespace tandem
