#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "tandem/falcon/simulated_device.h"

#include "novint/falcon_kinematics.h"

namespace tandem {

/// Parameters of an emulated Falcon's mechanism.
struct FalconPlantSettings {
  double mass = 0.15;                     ///< moving mass seen at the grip [kg]; inferred
  double viscous = 0.5;                   ///< viscous friction [N s/m]
  double coulomb = 0.1;                   ///< Coulomb friction [N]
  Vec3 gravity_D = Vec3::Zero();          ///< gravity on the moving mass [m/s^2]
  Vec3 start_D = Vec3(0.0, 0.0, 0.125);   ///< initial position of the grip, within reach [m]
  Vec3 centre_D = Vec3(0.0, 0.0, 0.125);  ///< origin of the hand's coordinates [m]
  /// True value of this device [1/(N m)]; a driver knows it only roughly.
  double motors_per_torque = kUsualMotorsPerTorque;
  double stop_stiffness = 5000.0;                 ///< of the workspace's stops [N/m]
  double stop_damping = 20.0;                     ///< of the workspace's stops [N s/m]
  Vec3 half_extents = Vec3(0.055, 0.055, 0.055);  ///< from the centre to the stops [m]
};

/// A point mass moved by three motors, friction, stops and a simulated hand, with the exact
/// geometry of the legs. Pure: the caller passes the time.
class FalconPlant {
 public:
  /// Throws std::invalid_argument if the start is out of reach or a value out of range. `hand` may
  /// be null. It gets the grip's position relative to the centre, along D's axes.
  FalconPlant(const FalconPlantSettings& settings, std::unique_ptr<Hand> hand);

  /// Simulates until `now` with the current motor commands.
  void advance(double now) noexcept;
  void setMotors(const FalconMotors& motors) noexcept { motors_ = motors; }
  /// Clamps the grip at `p_D` until it is called with nothing. Returns false out of reach.
  bool hold(const std::optional<Vec3>& p_D) noexcept;

  [[nodiscard]] const Vec3& position() const noexcept { return pose_.p_D; }  ///< [m], in D
  [[nodiscard]] const Vec3& velocity() const noexcept { return v_D_; }
  [[nodiscard]] const FalconAngles& angles() const noexcept { return pose_.angles; }
  /// Force of the motors on the grip [N].
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
