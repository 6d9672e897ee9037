#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "tandem/falcon/simulated_device.h"

#include "novint/falcon_kinematics.h"

#pragma GCC visibility push(default)
namespace tandem {

/// The mechanism of an emulated Falcon.
struct FalconPlantSettings {
  double mass = 0.15;                     ///< of all that moves, at the grip [kg]; inferred
  double viscous = 0.5;                   ///< friction [N s/m]
  double coulomb = 0.1;                   ///< friction that does not grow with speed [N]
  Vec3 gravity_D = Vec3::Zero();          ///< what the grip's weight pulls by [m/s^2]
  Vec3 start_D = Vec3(0.0, 0.0, 0.125);   ///< where the grip is at first, in reach [m]
  Vec3 centre_D = Vec3(0.0, 0.0, 0.125);  ///< the origin of the hand's coordinates [m]
  /// The device's own, which a driver does not know for sure [1/(N m)].
  double motors_per_torque = kUsualMotorsPerTorque;
  double stop_stiffness = 5000.0;                 ///< of the ends of the workspace [N/m]
  double stop_damping = 20.0;                     ///< [N s/m]
  Vec3 half_extents = Vec3(0.055, 0.055, 0.055);  ///< between the stops, around the centre [m]
};

/// A point mass that three motors, friction, stops and a simulated hand move, with the exact
/// geometry of the legs. Pure: time is told.
class FalconPlant {
 public:
  /// Throws std::invalid_argument for a start out of reach or values out of range. `hand` may be
  /// null; it sees the grip's position from the centre, along D's axes.
  FalconPlant(const FalconPlantSettings& settings, std::unique_ptr<Hand> hand);

  /// Moves on to `now`, with the motors as they are.
  void advance(double now) noexcept;
  void setMotors(const FalconMotors& motors) noexcept { motors_ = motors; }
  /// Held there from now on as by a vice; nothing: let go. False out of reach.
  bool hold(const std::optional<Vec3>& p_D) noexcept;

  [[nodiscard]] const Vec3& position() const noexcept { return pose_.p_D; }  ///< [m], in D
  [[nodiscard]] const Vec3& velocity() const noexcept { return v_D_; }
  [[nodiscard]] const FalconAngles& angles() const noexcept { return pose_.angles; }
  /// What the motors push the grip with [N].
  [[nodiscard]] Vec3 force() const noexcept;

 private:
  [[nodiscard]] Vec3 computePush(double t) const noexcept;
  void step(double h) noexcept;
  void moveTo(const Vec3& p_D) noexcept;

  FalconPlantSettings settings_;
  std::unique_ptr<Hand> hand_;
  FalconKinematics kinematics_;
  FalconPose pose_;
  Vec3 v_D_ = Vec3::Zero();
  FalconMotors motors_{};
  std::optional<Vec3> held_D_;
  double time_ = 0.0;
  bool has_time_ = false;
};

}  // namespace tandem
#pragma GCC visibility pop
