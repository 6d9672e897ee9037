#pragma once

#include <cstdint>

#include "joints/joint_settings.h"

class btMultiBody;
class btMultiBodyConstraint;
class btRigidBody;

namespace tandem {

/// The island makes this of a constraint of multi-bodies.
enum class ArmConstraintKind : std::uint8_t {
  kUnknown,  ///< nothing: a type of the host's own
  kGear,     ///< nothing: it couples up to four links, and rows have two ends
  // These are settings of the axis of a joint with one degree of freedom (ArmJoints).
  kJointMotor,
  kJointLimit,
  // Joints of their own (ArmConstraints).
  kSphericalMotor,
  kSphericalLimit,
  kPoint,
  kFixed,
  kSlider,
};

/// Exactly these types of Bullet, none derived from them.
[[nodiscard]] ArmConstraintKind findKind(const btMultiBodyConstraint& host) noexcept;

/// True if the island holds it as a joint of its own.
[[nodiscard]] inline bool isJointOfItsOwn(ArmConstraintKind kind) noexcept {
  return kind > ArmConstraintKind::kJointLimit;
}

/// True if it holds a link at something else than the link's own parent.
[[nodiscard]] inline bool isTie(ArmConstraintKind kind) noexcept {
  return kind >= ArmConstraintKind::kPoint;
}

/// An end of a constraint: a link, a rigid body, or a place of the world.
struct ArmConstraintEnd {
  btMultiBody* arm = nullptr;
  int link = -1;  ///< of the arm; -1: its base
  btRigidBody* rigid = nullptr;

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
/// links and bodies that it joins. Masses of drives are left out. Real-time safe.
[[nodiscard]] JointSettings readConstraint(btMultiBodyConstraint& host,
                                           const HostSolver& solver) noexcept;

/// Turns angular impulses about a slider's own axes to those about axes of its frame A.
[[nodiscard]] Vec3 turnToFrame(btMultiBodyConstraint& slider, const Vec3& by_axes) noexcept;

}  // namespace tandem
