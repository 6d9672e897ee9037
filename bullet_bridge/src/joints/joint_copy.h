#pragma once

#include <type_traits>
#include <vector>

#include "joints/joint_reading.h"

namespace tandem {

/// Kind of a row of one axis. Numbers of rows are 6 kind + axis.
enum class JointRowKind {
  kHold = 0,       ///< locked, or the lower limit
  kHighLimit = 1,  ///< the upper limit
  kDrive = 2,      ///< a motor
  kElastic = 3,    ///< a spring, or a force that acts whatever the motor does
};

/// Private copy of a joint of the host's: it gives the joint's rows at any poses, and needs neither
/// the host's joint nor its bodies for that.
///
/// It copies what the joint says of itself by Bullet's getters, and measures its coordinates in
/// double. So float hosts get exact rows too, and nothing hides in the copy between two calls.
/// Ends are in Bullet's order, A and B. It is a plain value: copying it allocates nothing.
class JointCopy {
 public:
  /// True if the joint is of a type that can be copied; exactly that type, none derived from it.
  [[nodiscard]] static bool isKnown(const btTypedConstraint& host) noexcept {
    return isKnownJoint(host);
  }

  /// Copies a joint of a known type, which it only reads. In the host's thread.
  JointCopy(btTypedConstraint& host, const HostSolver& solver) noexcept { refresh(host, solver); }

  /// A joint that has been read out already.
  explicit JointCopy(const JointSettings& joint) noexcept : joint_(joint) {}

  /// Copies it again, once per host step: motors, limits and targets may be new. In the host's
  /// thread.
  void refresh(btTypedConstraint& host, const HostSolver& solver) noexcept {
    joint_ = readJoint(host, solver);
  }

  /// Adds the rows at given poses and velocities of A and B, at most kMostJointRows. A limit is
  /// there while the way to it is below kLimitReach, or is passed within kLimitTime. Real-time
  /// safe if `rows` has room.
  void evaluate(const RigidState& a, const RigidState& b,
                std::vector<JointRow>& rows) const noexcept;

  /// Force or torque of any row beyond which the host's joint breaks [N or N m]; HUGE_VAL: none.
  [[nodiscard]] double breakingForce() const noexcept {
    return joint_.breaking_impulse / joint_.host_dt;
  }
  [[nodiscard]] bool isEnabled() const noexcept { return joint_.is_enabled; }
  [[nodiscard]] const JointSettings& settings() const noexcept { return joint_; }
  [[nodiscard]] static JointRowKind kindOf(const JointRow& row) noexcept {
    return static_cast<JointRowKind>(row.number / 6);
  }
  [[nodiscard]] static std::size_t numberOf(JointRowKind kind, std::size_t axis) noexcept {
    return 6 * static_cast<std::size_t>(kind) + axis;
  }

  static constexpr double kLimitReach = 0.01;     ///< [m or rad]
  static constexpr double kLimitTime = 1 / 60.0;  ///< [s]

 private:
  JointSettings joint_;
};
static_assert(std::is_trivially_destructible_v<JointCopy>);

/// The same row with both ends exchanged.
[[nodiscard]] inline JointRow exchangeEnds(JointRow row) noexcept {
  row.n_W = -row.n_W;
  std::swap(row.turn_a_W, row.turn_b_W);
  return row;
}

}  // namespace tandem
