#pragma once

#include <cstdint>
#include <stdexcept>

#include <Eigen/Core>
#include <Eigen/Geometry>

/// \file
/// Basic types of Tandem, in SI units. Frames: W is the world, right-handed and the same for
/// all peers. B is a body, with its origin at the centre of mass. D is the device.
#pragma GCC visibility push(default)
namespace tandem {

using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;

/// A user together with the computer that runs that user's copy of the virtual environment.
enum class PeerId : std::uint32_t {};
/// Live sites have ids from 1 to this.
inline constexpr std::uint32_t kMaxPeerId = 64;

/// Identity of a shared object, equal at all peers (its place in the scenario).
using ObjectId = std::uint32_t;

/// Counts haptic periods since the start; time is `tick * haptic_period`, never an accumulated sum.
using Tick = std::uint64_t;

/// Position and velocity of a point in W [m, m/s].
struct PointState {
  Vec3 p_W = Vec3::Zero();
  Vec3 v_W = Vec3::Zero();
};

/// Pose and velocity of a rigid body in W: centre of mass, orientation, linear [m/s] and angular
/// velocity [rad/s].
struct RigidState {
  Vec3 p_W = Vec3::Zero();
  Quat q_WB = Quat::Identity();
  Vec3 v_W = Vec3::Zero();
  Vec3 w_W = Vec3::Zero();

  [[nodiscard]] PointState point() const { return {p_W, v_W}; }
};

/// Orientation of a hand H in W, and its angular velocity [rad/s].
struct WristState {
  Quat q_WH = Quat::Identity();
  Vec3 w_W = Vec3::Zero();
};

[[nodiscard]] inline bool isFinite(const PointState& s) noexcept {
  return s.p_W.allFinite() && s.v_W.allFinite();
}

[[nodiscard]] inline bool isFinite(const RigidState& s) noexcept {
  return s.p_W.allFinite() && s.v_W.allFinite() && s.w_W.allFinite() && s.q_WB.coeffs().allFinite();
}

[[nodiscard]] inline bool isFinite(const WristState& s) noexcept {
  return s.q_WH.coeffs().allFinite() && s.w_W.allFinite();
}

/// A set-up that cannot work. The message is one line with the value and the remedy.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace tandem
#pragma GCC visibility pop
