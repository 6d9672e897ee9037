#pragma once

#include <cstdint>

#include "joints/joint_settings.h"

class btMultiBody;
class btMultiBodyConstraint;
class btRigidBody;

namespace tandem {

/// What the island makes of a constraint of multi-bodies.
enum class ArmConstraintKind : std::uint8_t {
  kUnknown,  ///< nothing: a type of the host's own
  // Of a joint with one degree of freedom: settings of its axis (ArmJoints).
  kJointMotor,
  kJointLimit,
  // Joints of their own (ArmConstraints).
  kSphericalMotor,
  kSphericalLimit,
};

/// Exactly these types of Bullet, none derived from them.
[[nodiscard]] ArmConstraintKind findKind(const btMultiBodyConstraint& host) noexcept;

/// True if the island holds it as a joint of its own.
[[nodiscard]] inline bool isJointOfItsOwn(ArmConstraintKind kind) noexcept {
  return kind > ArmConstraintKind::kJointLimit;
}

/// An end of a constraint.
struct ArmConstraintEnd {
  btMultiBody* arm = nullptr;
  int link = -1;  ///< of the arm; -1: its base

  [[nodiscard]] bool operator==(const ArmConstraintEnd&) const noexcept = default;
};

struct ArmConstraintEnds {
  ArmConstraintEnd a, b;

  [[nodiscard]] bool operator==(const ArmConstraintEnds&) const noexcept = default;
};

/// Ends of a constraint of a known kind.
[[nodiscard]] ArmConstraintEnds findEnds(btMultiBodyConstraint& host) noexcept;

/// Why the island cannot hold a constraint, as the end of a sentence; null: it can.
[[nodiscard]] const char* findObstacleToHold(btMultiBodyConstraint& host) noexcept;

/// Reads a joint of its own as it is now, with Bullet's step and erp. Its frames are those of the
/// links that it joins. Masses of drives are left out. Real-time safe.
[[nodiscard]] JointSettings readConstraint(btMultiBodyConstraint& host,
                                           const HostSolver& solver) noexcept;

}  // namespace tandem
