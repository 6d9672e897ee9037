#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/falcon/falcon_settings.h"

/// \file
/// The Novint Falcon as a mechanism: three legs, each an arm that a motor turns and a parallelogram
/// that carries the grip, around the axis towards the user. Frame D: origin in the base plane, x
/// right, y up, z out of the device towards the user.
#pragma GCC visibility push(default)
namespace tandem {

/// Angles of the three arms, from the base plane towards the user [rad].
using FalconAngles = Vec3;

/// A grip's position with the angles that belong to it, and how both change together.
struct FalconPose {
  Vec3 p_D = Vec3::Zero();
  FalconAngles angles = FalconAngles::Zero();
  Eigen::Matrix3d dangles_dp = Eigen::Matrix3d::Zero();  ///< rows: legs [rad/m]
};

/// Position from angles, angles from position, torques from forces. The leg's plane has the
/// coordinates
///
///   u = x cos(phi) + y sin(phi) - (r - c),  v = -x sin(phi) + y cos(phi) - (s - f),  w = z
///
/// and the rod's length ties them to the angle: with rho = hypot(u - a cos(th), w - a sin(th)),
///
///   F = (rho - (d + e))^2 + v^2 - b^2 = 0
///
/// Pure and real-time safe.
class FalconKinematics {
 public:
  explicit FalconKinematics(const FalconGeometry& geometry = {}) noexcept;

  /// Closed form. Nothing where no leg reaches, or for a position that is not finite.
  [[nodiscard]] std::optional<FalconAngles> computeAngles(const Vec3& p_D) const noexcept;

  /// By Newton's method from `guess_D`; the fixed default converges in the whole workspace.
  /// Nothing if there is no such position within reach.
  [[nodiscard]] std::optional<FalconPose> computePoseOfAngles(
      const FalconAngles& angles, const Vec3& guess_D = Vec3(0.0, 0.0, 0.125)) const noexcept;

  /// Both at once, for a position in reach.
  [[nodiscard]] std::optional<FalconPose> computePose(const Vec3& p_D) const noexcept;

 private:
  /// u, v, w of a leg.
  [[nodiscard]] Vec3 toLeg(std::size_t leg, const Vec3& p_D) const noexcept;

  /// How F and its slopes are at one leg.
  struct Leg {
    double value = 0.0;     ///< F [m^2]
    double folding = 0.0;   ///< rho - (d + e) [m]: below 0 the rod is folded back
    Vec3 by_p_D;            ///< dF/dp [m]
    double by_angle = 0.0;  ///< dF/dtheta [m^2/rad]
  };
  /// `elbow`: a (cos, sin) of the arm's angle [m].
  [[nodiscard]] Leg look(std::size_t leg, const Vec3& p_D,
                         const Eigen::Vector2d& elbow) const noexcept;
  /// Of the arms, each in its leg's plane [m].
  using Elbows = std::array<Eigen::Vector2d, 3>;
  [[nodiscard]] Elbows findElbows(const FalconAngles& angles) const noexcept;
  [[nodiscard]] bool finish(FalconPose& pose, const Elbows& elbows) const noexcept;

  FalconGeometry geometry_;
  std::array<double, 3> cos_, sin_;  ///< of the azimuths
};

/// Torques of the motors, at the arms [N m], that make the grip push with `f_D` [N]: virtual work,
/// tau . dtheta = f . dp. Nothing where the legs are stretched and cannot.
[[nodiscard]] std::optional<Vec3> computeTorques(const FalconPose& pose, const Vec3& f_D) noexcept;

/// Velocity of the grip [m/s] while the arms turn at `angle_rates` [rad/s]. Nothing where the legs
/// are stretched and do not say.
[[nodiscard]] std::optional<Vec3> computeVelocity(const FalconPose& pose,
                                                  const Vec3& angle_rates) noexcept;

/// Counts of the encoders by the angle of an arm: 1280 a turn of the motor, geared 110 : 14.25,
/// counted from 35 degrees.
[[nodiscard]] double angleOfCounts(double counts) noexcept;
/// The same of a change: 6.35905e-4 rad per count.
[[nodiscard]] Vec3 angleRatesOfCounts(const Vec3& count_rates) noexcept;
[[nodiscard]] double countsOfAngle(double angle) noexcept;

/// What the motors take: -4095 to 4095.
using FalconMotors = std::array<std::int16_t, 3>;
inline constexpr std::int16_t kMostMotor = 4095;

/// Commands for torques, all three scaled alike where one is out of range, so that the force keeps
/// its direction. Zero for torques that are not finite: it never wraps.
[[nodiscard]] FalconMotors makeMotorCommands(
    const Vec3& torques, double motors_per_torque = kUsualMotorsPerTorque) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
