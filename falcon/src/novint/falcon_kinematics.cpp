#include "novint/falcon_kinematics.h"

#include <cmath>

#include <Eigen/LU>

namespace tandem {
namespace {

constexpr int kMostSteps = 20;          // Newton's method needs at most 8 in the whole workspace
constexpr double kSolved = 1e-13;       // largest |F| of a root [m^2]: 1e-12 m of the rod
constexpr double kConverged = 1e-15;    // |F| that ends the iteration [m^2]: 1e-14 m of the rod
constexpr double kLeastTurning = 1e-9;  // dF/dtheta of a stretched leg [m^2/rad]

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

Vec3 FalconKinematics::toLeg(std::size_t leg, const Vec3& p_D) const noexcept {
  const double c = cos_[leg], s = sin_[leg];
  return {p_D.x() * c + p_D.y() * s - geometry_.base_less_grip,
          -p_D.x() * s + p_D.y() * c - geometry_.aside, p_D.z()};
}

std::optional<FalconAngles> FalconKinematics::computeAngles(const Vec3& p_D) const noexcept {
  const FalconGeometry& g = geometry_;
  FalconAngles angles;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 uvw = toLeg(i, p_D);
    const double across = g.rod * g.rod - uvw.y() * uvw.y();
    if (!(across >= 0.0)) return std::nullopt;
    const double length = g.rod_ends + std::sqrt(across);
    const double reach = std::hypot(uvw.x(), uvw.z());
    const double cosine = (reach * reach + g.arm * g.arm - length * length) / (2.0 * g.arm * reach);
    if (!(std::abs(cosine) <= 1.0)) return std::nullopt;
    angles[static_cast<Eigen::Index>(i)] = std::atan2(uvw.z(), uvw.x()) - std::acos(cosine);
  }
  return angles;
}

FalconKinematics::Leg FalconKinematics::look(std::size_t leg, const Vec3& p_D,
                                             const Eigen::Vector2d& elbow) const noexcept {
  const FalconGeometry& g = geometry_;
  const double c = cos_[leg], s = sin_[leg];
  const Vec3 uvw = toLeg(leg, p_D);
  const double along = uvw.x() - elbow.x(), v = uvw.y(), up = uvw.z() - elbow.y();
  const double rho = std::sqrt(along * along + up * up);
  const double q = rho - g.rod_ends;
  const double by_rho = 2.0 * q / rho, by_u = by_rho * along, by_v = 2.0 * v;
  Leg result;
  result.value = q * q + v * v - g.rod * g.rod;
  result.folding = q;
  result.by_p_D = Vec3(by_u * c - by_v * s, by_u * s + by_v * c, by_rho * up);
  result.by_angle = by_rho * (along * elbow.y() - up * elbow.x());
  return result;
}

std::optional<FalconPose> FalconKinematics::computePoseOfAngles(
    const FalconAngles& angles, const Vec3& guess_D) const noexcept {
  FalconPose pose{guess_D, angles, Eigen::Matrix3d::Zero()};
  const Elbows elbows = findElbows(angles);
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix3d by_p;
    Vec3 value;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Leg leg = look(k, pose.p_D, elbows[k]);
      by_p.row(i) = leg.by_p_D;
      value[i] = leg.value;
    }
    if (value.cwiseAbs().maxCoeff() <= kConverged) break;
    pose.p_D -= by_p.inverse() * value;
    if (!pose.p_D.allFinite()) return std::nullopt;
  }
  if (!finish(pose, elbows)) return std::nullopt;
  return pose;
}

std::optional<FalconPose> FalconKinematics::computePose(const Vec3& p_D) const noexcept {
  const std::optional<FalconAngles> angles = computeAngles(p_D);
  if (!angles) return std::nullopt;
  FalconPose pose{p_D, *angles, Eigen::Matrix3d::Zero()};
  if (!finish(pose, findElbows(*angles))) return std::nullopt;
  return pose;
}

FalconKinematics::Elbows FalconKinematics::findElbows(const FalconAngles& angles) const noexcept {
  Elbows elbows;
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = angles[static_cast<Eigen::Index>(i)];
    elbows[i] = geometry_.arm * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return elbows;
}

/// Computes dtheta/dp = -(dF/dp) / (dF/dtheta), leg by leg. Returns false if this is no pose of the
/// device: the equation has other roots, with a rod folded back or an elbow on the wrong side.
bool FalconKinematics::finish(FalconPose& pose, const Elbows& elbows) const noexcept {
  for (Eigen::Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Leg leg = look(k, pose.p_D, elbows[k]);
    if (!(std::abs(leg.value) <= kSolved && leg.folding >= 0.0 && leg.by_angle < -kLeastTurning))
      return false;
    pose.dangles_dp.row(i) = -leg.by_p_D / leg.by_angle;
  }
  return pose.dangles_dp.allFinite();
}

std::optional<Vec3> computeTorques(const FalconPose& pose, const Vec3& f_D) noexcept {
  const Vec3 torques = pose.dangles_dp.transpose().inverse() * f_D;
  if (!torques.allFinite()) return std::nullopt;
  return torques;
}

std::optional<Vec3> computeVelocity(const FalconPose& pose, const Vec3& angle_rates) noexcept {
  const Vec3 v_D = pose.dangles_dp.inverse() * angle_rates;
  if (!v_D.allFinite()) return std::nullopt;
  return v_D;
}

double angleOfCounts(double counts) noexcept { return counts * kRadiansPerCount + kAngleOfZero; }
Vec3 angleRatesOfCounts(const Vec3& count_rates) noexcept { return kRadiansPerCount * count_rates; }
double countsOfAngle(double angle) noexcept { return (angle - kAngleOfZero) / kRadiansPerCount; }

FalconMotors makeMotorCommands(const Vec3& torques, double motors_per_torque) noexcept {
  if (!torques.allFinite() || !std::isfinite(motors_per_torque)) return {};
  // Scale before multiplying: huge torques would overflow.
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
