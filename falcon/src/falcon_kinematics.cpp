#include "tandem/falcon/falcon_kinematics.h"

#include <cmath>

#include <Eigen/LU>

namespace tandem {
namespace {

constexpr int kMostSteps = 20;          // of Newton's method; 8 are enough in the whole workspace
constexpr double kConverged = 1e-15;    // of F [m^2]: 1e-14 m of the rod
constexpr double kLeastTurning = 1e-9;  // dF/dtheta of a leg that is stretched [m^2/rad]

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadiansPerCount = 2.0 * kPi / 1280.0 * (14.25 / 110.0);
constexpr double kAngleOfZero = 35.0 * kPi / 180.0;

}  // namespace

FalconKinematics::FalconKinematics(const FalconGeometry& geometry) noexcept : geometry_(geometry) {
  for (std::size_t i = 0; i < 3; ++i) {
    cos_[i] = std::cos(geometry.azimuths[i]);
    sin_[i] = std::sin(geometry.azimuths[i]);
  }
}

std::optional<FalconAngles> FalconKinematics::computeAngles(const Vec3& p_D) const noexcept {
  const FalconGeometry& g = geometry_;
  FalconAngles angles;
  for (std::size_t i = 0; i < 3; ++i) {
    const double u = p_D.x() * cos_[i] + p_D.y() * sin_[i] - g.base_less_grip;
    const double v = -p_D.x() * sin_[i] + p_D.y() * cos_[i] - g.aside;
    const double w = p_D.z();
    const double across = g.rod * g.rod - v * v;
    if (!(across >= 0.0)) return std::nullopt;
    const double length = g.rod_ends + std::sqrt(across);
    const double reach = std::hypot(u, w);
    const double cosine = (reach * reach + g.arm * g.arm - length * length) / (2.0 * g.arm * reach);
    if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
    angles[static_cast<Eigen::Index>(i)] = std::atan2(w, u) - std::acos(cosine);
  }
  return angles;
}

FalconKinematics::Leg FalconKinematics::look(std::size_t leg, const Vec3& p_D,
                                             double angle) const noexcept {
  const FalconGeometry& g = geometry_;
  const double c = cos_[leg], s = sin_[leg];
  const double along = p_D.x() * c + p_D.y() * s - g.base_less_grip - g.arm * std::cos(angle);
  const double up = p_D.z() - g.arm * std::sin(angle);
  const double v = -p_D.x() * s + p_D.y() * c - g.aside;
  const double rho = std::hypot(along, up);
  const double q = rho - g.rod_ends;
  const double by_u = 2.0 * q * along / rho, by_w = 2.0 * q * up / rho, by_v = 2.0 * v;
  Leg result;
  result.value = q * q + v * v - g.rod * g.rod;
  result.by_p_D = Vec3(by_u * c - by_v * s, by_u * s + by_v * c, by_w);
  result.by_angle = 2.0 * q * g.arm * (along * std::sin(angle) - up * std::cos(angle)) / rho;
  return result;
}

std::optional<FalconPose> FalconKinematics::computePoseOfAngles(
    const FalconAngles& angles, const Vec3& guess_D) const noexcept {
  FalconPose pose{guess_D, angles, Eigen::Matrix3d::Zero()};
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix3d by_p;
    Vec3 value;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const Leg leg = look(static_cast<std::size_t>(i), pose.p_D, angles[i]);
      by_p.row(i) = leg.by_p_D;
      value[i] = leg.value;
    }
    if (value.cwiseAbs().maxCoeff() <= kConverged) break;
    const Vec3 change_D = by_p.inverse() * value;
    if (!change_D.allFinite()) return std::nullopt;
    pose.p_D -= change_D;
    if (change_D.norm() < 1e-16) break;
  }
  // What Newton's method found may be no solution, or one behind the device.
  if (!pose.p_D.allFinite() || !finish(pose)) return std::nullopt;
  const std::optional<FalconAngles> back = computeAngles(pose.p_D);
  constexpr double kSame = 1e-9;  // [rad]
  if (!back || !((*back - angles).cwiseAbs().maxCoeff() < kSame)) return std::nullopt;
  return pose;
}

std::optional<FalconPose> FalconKinematics::computePose(const Vec3& p_D) const noexcept {
  const std::optional<FalconAngles> angles = computeAngles(p_D);
  if (!angles) return std::nullopt;
  FalconPose pose{p_D, *angles, Eigen::Matrix3d::Zero()};
  if (!finish(pose)) return std::nullopt;
  return pose;
}

/// dtheta/dp = -(dF/dp) / (dF/dtheta), leg by leg.
bool FalconKinematics::finish(FalconPose& pose) const noexcept {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Leg leg = look(static_cast<std::size_t>(i), pose.p_D, pose.angles[i]);
    if (!(std::abs(leg.by_angle) > kLeastTurning)) return false;
    pose.dangles_dp.row(i) = -leg.by_p_D / leg.by_angle;
  }
  return pose.dangles_dp.allFinite();
}

std::optional<Vec3> computeTorques(const FalconPose& pose, const Vec3& f_D) noexcept {
  const Vec3 torques = pose.dangles_dp.transpose().inverse() * f_D;
  if (!torques.allFinite()) return std::nullopt;
  return torques;
}

double angleOfCounts(double counts) noexcept { return counts * kRadiansPerCount + kAngleOfZero; }
double countsOfAngle(double angle) noexcept { return (angle - kAngleOfZero) / kRadiansPerCount; }

FalconMotors makeMotorCommands(const Vec3& torques, double motors_per_torque) noexcept {
  if (!torques.allFinite() || !std::isfinite(motors_per_torque)) return {};
  // Scaled to what fits before it is multiplied, as huge torques would overflow.
  const double largest = torques.cwiseAbs().maxCoeff();
  const double most = static_cast<double>(kMostMotor) / std::abs(motors_per_torque);
  const double factor = largest > most ? motors_per_torque * (most / largest) : motors_per_torque;
  FalconMotors motors{};
  for (Eigen::Index i = 0; i < 3; ++i)
    motors[static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(std::lround(-factor * torques[i]));
  return motors;
}

}  // namespace tandem
