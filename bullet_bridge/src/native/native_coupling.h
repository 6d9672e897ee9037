#pragma once

#include <memory>

#include "coordination/src/island/island.h"

class btCollisionObject;
class btDiscreteDynamicsWorld;
class btRigidBody;

/// \file
/// What Bullet itself offers for the laws of the island, with the same gains: contact, couplers,
/// the slot of a guide, a body's damping, a sphere that a hand moves. It is there to be compared
/// with: nothing here is exact, and what explodes is left to explode. Not thread safe; all for the
/// thread that steps the world, and all real-time safe but constructors and destructors.
#pragma GCC visibility push(default)
namespace tandem {

/// Makes the contacts of `carrier` compliant: K overlap + B overlap_rate per pair, by Bullet's
/// contact stiffness and damping, which is implicit Euler.
///
/// Bullet has its gains per contact point, so a pair that touches in n points needs K/n and B/n:
/// `points` is that n, 1 for a sphere. The partner has to be rigid. Where both carry, they are in
/// series: 1/K = 1/K_a + 1/K_b, and dampings add. A rigid partner, too, adds the damping that every
/// btCollisionObject is born with, 0.1 N s/m; it is taken off here. Deeper than the world's
/// m_splitImpulsePenetrationThreshold (40 mm) Bullet pushes by position instead, and no force is
/// seen: the threshold is the host's. Stays until set again.
void setSoftContact(btCollisionObject& carrier, const CouplerGains& gains, int points = 1);

/// Impulse that a body had from its contacts in the world's latest step, friction included, in W
/// [N s]. Divided by the step it is the mean force of that step.
[[nodiscard]] Vec3 computeContactImpulse(btDiscreteDynamicsWorld& world,
                                         const btCollisionObject& body) noexcept;

/// How deep a body is in others, ghosts apart, by the contacts of the world's latest step [m]; 0:
/// in none. A ghost's own contacts are seen.
[[nodiscard]] double computeNativeOverlap(btDiscreteDynamicsWorld& world,
                                          const btCollisionObject& body) noexcept;

/// A ghost's contacts are found and not acted on.
void setNativeGhost(btCollisionObject& body, bool is_ghost) noexcept;

/// Gives a body the damping b [N s/m] of its velocity by Bullet's own factor per second,
/// 1 - exp(-b/m), which is exact while nothing else acts. Not restored here: HapticBody does that.
void setNativeDamping(btRigidBody& body, double damping);

/// Leaves a body one direction of motion and no rotation, by Bullet's linear and angular factors,
/// until destruction. Factors know the world's axes only.
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

/// A kinematic sphere of a host's world: it goes where it is told, pushes whatever moves and feels
/// nothing. Bullet knows no contact between it and static or other kinematic bodies, so it passes
/// these. No friction. The world must outlive it.
class KinematicSphere {
 public:
  KinematicSphere(btDiscreteDynamicsWorld& world, double radius, const Vec3& p_W);
  ~KinematicSphere();
  KinematicSphere(const KinematicSphere&) = delete;
  KinematicSphere& operator=(const KinematicSphere&) = delete;

  /// While it is in the world.
  [[nodiscard]] btRigidBody& rigid() const noexcept;
  [[nodiscard]] bool isInWorld() const noexcept;
  [[nodiscard]] RigidState state() const noexcept;

  /// Pre-tick: it moves to `end_W` [m] over this step of dt [s], at even speed.
  void moveTo(const Vec3& end_W, double dt) noexcept;
  /// Post-tick: it is where moveTo() sent it.
  void arrive() noexcept;
  /// Pre-tick: it stands at the state's position, while contacts count with the state's velocity.
  void hold(const PointState& state) noexcept;

 private:
  struct [[gnu::visibility("hidden")]] Impl;
  std::unique_ptr<Impl> impl_;
};

/// Means by which Bullet can pull a body towards a target.
enum class NativeCouplerKind {
  kImpulse,       ///< F dt in the pre-tick, by hand: semi-implicit Euler
  kSpring6Dof,    ///< btGeneric6DofSpring2Constraint, unclamped: explicit, too, but Bullet's own
  kPointToPoint,  ///< btPoint2PointConstraint with ERP and CFM from K and B
};

/// A spring-damper from a body to a target that is set from outside and held in between: the law of
/// CouplerSettings by Bullet's own means.
///
/// The constraints hang on a kinematic anchor that is in no world; it stands at the target and has
/// its velocity, which dampers count. Point2Point is implicit Euler:
///   ERP = dt K / (dt K + B),   CFM = m / (dt (dt K + B))
/// where the mass undoes that Bullet leaves CFM out of the denominator of joint rows. For the same
/// reason its iteration diverges where that CFM is above 1, that is at small steps. A point has no
/// orientation: the angular part of kPointToPoint is given by impulses.
class NativeCoupler {
 public:
  virtual ~NativeCoupler() = default;

  /// Multiplies the gains it was made with by a share in 0 to 1, from the next pull() on.
  virtual void setShare(double share) noexcept = 0;
  /// Pre-tick, before each step of dt [s]: pulls towards `target` over that step.
  virtual void pull(const RigidState& target, double dt) noexcept = 0;
};

/// Set-up. World and body must outlive the coupler; the body has its mass already. Throws
/// std::invalid_argument, naming the value, for gains that are negative or not finite.
[[nodiscard]] std::unique_ptr<NativeCoupler> makeNativeCoupler(NativeCouplerKind kind,
                                                               btDiscreteDynamicsWorld& world,
                                                               btRigidBody& body,
                                                               const CouplerSettings& settings);

}  // namespace tandem
#pragma GCC visibility pop
