#pragma once

#include <array>
#include <cmath>

#include "tandem/coordination/types.h"

#include "coordination/src/island/joint_source.h"

namespace tandem {

/// The host solver's settings that its joints depend on.
struct HostSolver {
  double dt = 1.0 / 60.0;  ///< a step of the host [s]
  double erp = 0.2;        ///< part of an error that a step corrects, where a joint says nothing
  int iterations = 10;
};

/// A joint's frame in its body.
struct JointFrame {
  Vec3 p = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  [[nodiscard]] bool operator==(const JointFrame&) const noexcept = default;
};

enum class JointMotor : std::uint8_t {
  kNone,
  kSpeed,   ///< brings u to `speed`
  kServo,   ///< brings the coordinate to `target`, at most at `speed`
  kSpring,  ///< btGeneric6DofSpringConstraint's: its greatest force is that of the spring
  kTurn,    ///< a cone twist joint's: turns the angle that is left away, and never brakes
  kDrive,   ///< a multi-body's: to `speed`, with a part of the way to `target`
};

/// A coordinate of a joint, and all that acts along it. Coordinates are as Bullet tells
/// them to the host; their rate is `sense` times the speed u of their row.
struct JointAxis {
  double low = 1.0, high = -1.0;  ///< range [m or rad]; equal: locked; low above high: free
  int sense = 1;                  ///< 1 or -1
  double bounce = 0.0;
  double erp = 1.0;              ///< used where cfm is not 0
  double cfm = 0.0;              ///< Bullet's softness: a number
  double hold_force = HUGE_VAL;  ///< most force of a locked axis [N]

  JointMotor motor = JointMotor::kNone;
  double speed = 0.0;   ///< wanted u [m/s or rad/s]
  double force = 0.0;   ///< greatest [N or N m]
  double target = 0.0;  ///< of a servo [m or rad]
  double gain = 0.0;    ///< speed per error of a servo or turn [1/s]; speed per force of a spring

  // A drive mends `share` of the error of its speed in a step of the host.
  double share = 1.0;
  double most = HUGE_VAL;  ///< greatest speed that it wants [m/s or rad/s]
  double mass = 0.0;       ///< that it moves [kg or kg m^2]
  double push = 0.0;       ///< force that acts whatever the motor does [N or N m]

  bool has_spring = false;
  double stiffness = 0.0, damping = 0.0;
  double rest = 0.0;  ///< coordinate without force

  bool counts_turns = false;  ///< an angle's whole turns count, too
  double near = 0.0;          ///< angle that they bring it nearest to [rad]

  [[nodiscard]] bool isLocked() const noexcept { return low == high; }
  [[nodiscard]] bool isFree() const noexcept { return low > high; }
  void lock() noexcept { low = high = 0.0; }
  /// False: nothing ever acts along it.
  [[nodiscard]] bool acts() const noexcept { return !isFree() || isDriven(); }
  /// True if more than a range acts.
  [[nodiscard]] bool isDriven() const noexcept {
    return motor != JointMotor::kNone || has_spring || push != 0.0;
  }
  [[nodiscard]] bool operator==(const JointAxis&) const noexcept = default;
};

enum class JointKind : std::uint8_t {
  kPoint,
  kHinge,
  kSlider,
  kConeTwist,
  kSixDof,
  kGear,
  // Of multi-bodies.
  kWeld,      ///< points as kPoint, and the turn of frame a beside frame b, about axes of a
  kRail,      ///< ways along axes of a, and the turn as of kWeld
  kTiltTurn,  ///< tilts of z of frame a in frame b, about axes x and y of a; its turn about z
};

/// How a cone twist joint holds its swing, in axes 4 and 5.
enum class SwingKind : std::uint8_t {
  kFree,
  kCone,    ///< 4: what is left to the cone, a limit
  kFixed,   ///< 4 and 5: errors about y and z of frame a
  kAboutZ,  ///< 4: error out of the plane x y of frame a; 5: angle in it
  kAboutY,  ///< 4: error out of the plane x z of frame a; 5: angle in it
  kMotor,   ///< 4: turns frame a to its target in frame b
};

/// A cone twist joint's swing and motor.
struct SwingSettings {
  SwingKind kind = SwingKind::kFree;
  double span1 = 0.0, span2 = 0.0;                       ///< half angles of the cone [rad]
  Eigen::Matrix3d target = Eigen::Matrix3d::Identity();  ///< of frame a in frame b

  [[nodiscard]] bool operator==(const SwingSettings&) const noexcept = default;
};

/// Mass of an end, as in the host; 0 if it does not move.
struct EndMass {
  double inverse_mass = 0.0;
  Vec3 inverse_inertia_B = Vec3::Zero();

  [[nodiscard]] bool operator==(const EndMass&) const noexcept = default;
};

/// A host's joint, read out. Plain values, without any of Bullet's objects.
struct JointSettings {
  JointKind kind = JointKind::kPoint;
  JointFrame a, b;
  /// Coordinates: 0 to 2 linear, 3 to 5 angular. Those of a slider's sideways motion and of a
  /// hinge's tilt are errors, and locked.
  std::array<JointAxis, 6> axes;
  std::array<int, 3> order = {0, 1, 2};  ///< of Euler angles: the first axis is of b, the last of a
  bool holds_points = true;              ///< false: a hinge or weld that only aligns
  SwingSettings swing;
  double gear_ratio = 1.0;
  EndMass mass_a, mass_b;
  double host_dt = 1.0 / 60.0;         ///< [s]
  double breaking_impulse = HUGE_VAL;  ///< of a row in one step of the host [N s or N m s]
  bool is_enabled = true;

  [[nodiscard]] bool operator==(const JointSettings&) const noexcept = default;
};

}  // namespace tandem
