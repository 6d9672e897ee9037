#pragma once

#include <memory>

#include "coordination/src/island/island.h"

class btCollisionObject;
class btDiscreteDynamicsWorld;
class btRigidBody;

/// \file
/// Bullet's own means for the laws of the island, with the same gains: contact, couplers, the slot
/// of a guide, damping, a sphere that a hand moves. They serve as a comparison: none is exact, and
/// instability is not prevented. Not thread safe: for the thread that steps the world. All
/// functions except constructors and destructors are real-time safe.
#pragma GCC visibility push(default)
namespace tandem {

/// Makes the contacts of `carrier` compliant: K overlap + B overlap_rate per pair. It uses Bullet's
/// contact stiffness and damping, which is implicit Euler.
///
/// Bullet's gains are per contact point. A pair with n points therefore needs K/n and B/n; `points`
/// is n, 1 for a sphere. The partner must be rigid. If both are compliant, they act in series: 1/K
/// = 1/K_a + 1/K_b, and dampings add. Every btCollisionObject has a default damping of 0.1 N s/m,
/// also a rigid partner; it is subtracted here. Beyond the world's
/// m_splitImpulsePenetrationThreshold (40 mm) Bullet corrects positions without a force; the
/// threshold is the host's. Stays until set again.
void setSoftContact(btCollisionObject& carrier, const CouplerGains& gains, int points = 1);

/// Impulse on a body from its contacts in the world's latest step, with friction, in W [N s].
/// Divided by the step it is the mean force of that step.
[[nodiscard]] Vec3 computeContactImpulse(btDiscreteDynamicsWorld& world,
                                         const btCollisionObject& body) noexcept;

/// Deepest overlap of a body in others except ghosts, from the contacts of the world's latest step
/// [m]; 0 if none. It works for a ghost's own contacts.
[[nodiscard]] double computeNativeOverlap(btDiscreteDynamicsWorld& world,
                                          const btCollisionObject& body) noexcept;

/// Makes a body a ghost: its contacts are found but not resolved.
void setNativeGhost(btCollisionObject& body, bool is_ghost) noexcept;

/// Sets the damping b [N s/m] as Bullet's factor per second, 1 - exp(-b/m). It is exact while
/// nothing else acts. HapticBody restores it.
void setNativeDamping(btRigidBody& body, double damping);

/// Restricts a body to one direction of motion without rotation, by Bullet's linear and angular
/// factors, until destruction. Factors follow the world's axes only.
class NativeGuide {
 public:
  /// True if `axis` (a unit vector in W) lies along x, y or z.
  [[nodiscard]] static bool canFollow(const Vec3& axis) noexcept;

  /// The body must outlive this object. Throws std::invalid_argument for another axis.
  NativeGuide(btRigidBody& body, const Vec3& axis);
  ~NativeGuide();
  NativeGuide(const NativeGuide&) = delete;
  NativeGuide& operator=(const NativeGuide&) = delete;

 private:
  struct Original;
  std::unique_ptr<Original> original_;
};

/// A kinematic sphere in a host's world. It follows its commands, pushes moving bodies and feels
/// nothing. Bullet has no contact between it and static or other kinematic bodies, so it passes
/// them. No friction. The world must outlive it.
class KinematicSphere {
 public:
  KinematicSphere(btDiscreteDynamicsWorld& world, double radius, const Vec3& p_W);
  ~KinematicSphere();
  KinematicSphere(const KinematicSphere&) = delete;
  KinematicSphere& operator=(const KinematicSphere&) = delete;

  /// Valid only while it is in the world.
  [[nodiscard]] btRigidBody& rigid() const noexcept;
  [[nodiscard]] bool isInWorld() const noexcept;
  [[nodiscard]] RigidState state() const noexcept;

  /// Pre-tick: moves the sphere to `end_W` [m] over this step of dt [s], at constant speed.
  void moveTo(const Vec3& end_W, double dt) noexcept;
  /// Post-tick: places the sphere where moveTo() sent it.
  void arrive() noexcept;
  /// Pre-tick: holds the sphere at the state's position; contacts use the state's velocity.
  void hold(const PointState& state) noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

/// Bullet's means to pull a body towards a target.
enum class NativeCouplerKind {
  kImpulse,       ///< impulse F dt in the pre-tick: semi-implicit Euler
  kSpring6Dof,    ///< btGeneric6DofSpring2Constraint, unclamped: also explicit
  kPointToPoint,  ///< btPoint2PointConstraint with ERP and CFM from K and B
};

/// A spring-damper from a body to a target, which stays until set again: the law of CouplerSettings
/// by Bullet's own means.
///
/// The constraints use a kinematic anchor outside any world. It has the target's pose and velocity;
/// dampers use the velocity. Point2Point is implicit Euler:
///   ERP = dt K / (dt K + B),   CFM = m / (dt (dt K + B))
/// The mass is there because Bullet omits CFM from the denominator of joint rows. For the same
/// reason the iteration diverges where that CFM is above 1, at small steps. A point has no
/// orientation, so kPointToPoint applies its angular part by impulses.
class NativeCoupler {
 public:
  virtual ~NativeCoupler() = default;

  /// Scales the original gains by a share in 0 to 1, from the next pull() on.
  virtual void setShare(double share) noexcept = 0;
  /// Pre-tick, before each step of dt [s]: pulls towards `target` over that step.
  virtual void pull(const RigidState& target, double dt) noexcept = 0;
};

/// Set-up. World and body must outlive the coupler; the body must have its final mass. Throws
/// std::invalid_argument, naming the value, for negative or non-finite gains.
[[nodiscard]] std::unique_ptr<NativeCoupler> makeNativeCoupler(NativeCouplerKind kind,
                                                               btDiscreteDynamicsWorld& world,
                                                               btRigidBody& body,
                                                               const CouplerSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
