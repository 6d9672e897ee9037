#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tandem/coordination/types.h"
#include "tandem/falcon/falcon_settings.h"

/// \file
/// The Novint Falcon as a mechanism: three legs around the axis towards the user. Each leg has an
/// arm that a motor turns and a parallelogram that carries the grip. Frame D has its origin in the
/// base plane, x right, y up, z out of the device towards the user.
namespace tandem {

/// Angles of the three arms, from the base plane towards the user [rad].
using FalconAngles = Vec3;

/// Position of the grip, the arms' angles there, and the derivative between them.
struct FalconPose {
  Vec3 p_D = Vec3::Zero();
  FalconAngles angles = FalconAngles::Zero();
  Eigen::Matrix3d dangles_dp = Eigen::Matrix3d::Zero();  ///< row i: leg i [rad/m]
};

/// Computes position from angles, angles from position, and torques from forces. A leg's plane has
/// the coordinates
///
///   u = x cos(phi) + y sin(phi) - (r - c),  v = -x sin(phi) + y cos(phi) - (s - f),  w = z
///
/// The rod's length relates them to the angle: with rho = hypot(u - a cos(th), w - a sin(th)),
///
///   F = (rho - (d + e))^2 + v^2 - b^2 = 0
///
/// Pure and real-time safe.
class FalconKinematics {
 public:
  explicit FalconKinematics(const FalconGeometry& geometry = {}) noexcept;

  /// Closed form. Returns nothing if a leg does not reach `p_D` or it is not finite.
  [[nodiscard]] std::optional<FalconAngles> computeAngles(const Vec3& p_D) const noexcept;

  /// Newton's method from `guess_D`; the default converges in the whole workspace. Returns nothing
  /// if there is no such position within reach.
  [[nodiscard]] std::optional<FalconPose> computePoseOfAngles(
      const FalconAngles& angles, const Vec3& guess_D = Vec3(0.0, 0.0, 0.125)) const noexcept;

  /// Angles and derivative for a position within reach.
  [[nodiscard]] std::optional<FalconPose> computePose(const Vec3& p_D) const noexcept;

 private:
  /// Coordinates u, v, w of a leg.
  [[nodiscard]] Vec3 toLeg(std::size_t leg, const Vec3& p_D) const noexcept;

  /// F and its derivatives at one leg.
  struct Leg {
    double value = 0.0;     ///< F [m^2]
    double folding = 0.0;   ///< rho - (d + e) [m]; below 0 the rod is folded back
    Vec3 by_p_D;            ///< dF/dp [m]
    double by_angle = 0.0;  ///< dF/dtheta [m^2/rad]
  };
  /// `elbow` is a (cos, sin) of the arm's angle [m].
  [[nodiscard]] Leg look(std::size_t leg, const Vec3& p_D,
                         const Eigen::Vector2d& elbow) const noexcept;
  /// Elbows of the arms, each in its leg's plane [m].
  using Elbows = std::array<Eigen::Vector2d, 3>;
  [[nodiscard]] Elbows findElbows(const FalconAngles& angles) const noexcept;
  [[nodiscard]] bool finish(FalconPose& pose, const Elbows& elbows) const noexcept;

  FalconGeometry geometry_;
  std::array<double, 3> cos_, sin_;  ///< of the azimuths
};

/// Motor torques at the arms [N m] for a force `f_D` [N] of the grip, by virtual work: tau . dtheta
/// = f . dp. Returns nothing where the legs are stretched.
[[nodiscard]] std::optional<Vec3> computeTorques(const FalconPose& pose, const Vec3& f_D) noexcept;

/// Velocity of the grip [m/s] for arm rates `angle_rates` [rad/s]. Returns nothing where the legs
/// are stretched.
[[nodiscard]] std::optional<Vec3> computeVelocity(const FalconPose& pose,
                                                  const Vec3& angle_rates) noexcept;

/// Converts encoder counts to the angle of an arm: 1280 counts per motor turn, gear ratio 110 :
/// 14.25, zero at 35 degrees.
[[nodiscard]] double angleOfCounts(double counts) noexcept;
/// Converts rates of counts: 6.35905e-4 rad per count.
[[nodiscard]] Vec3 angleRatesOfCounts(const Vec3& count_rates) noexcept;
[[nodiscard]] double countsOfAngle(double angle) noexcept;

/// Range of a motor command: -4095 to 4095.
using FalconMotors = std::array<std::int16_t, 3>;
inline constexpr std::int16_t kMostMotor = 4095;

/// Motor commands for torques. If one is out of range, all three are scaled alike, so the force
/// keeps its direction. Non-finite torques give zero; nothing wraps.
[[nodiscard]] FalconMotors makeMotorCommands(
    const Vec3& torques, double motors_per_torque = kUsualMotorsPerTorque) noexcept;

}  // namespace tandem
