#pragma once

#include <string>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/coordination/types.h"

#include "bodies/body_look.h"
#include "bodies/host_body.h"
#include "bodies/momentum.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// Permission for Bullet to put a held body to sleep.
enum class Sleep {
  kNever,   ///< handed off, it stays awake; a sleeping body wakes, with all it touches
  kAsHost,  ///< Bullet decides; asleep, the body follows within 50 um and wakes beyond
};

/// A rigid body of the host's world whose motion the island decides.
///
/// During its life, built-in damping is off. The body sleeps only while parked or as `sleep`
/// allows. Mass and inertia are scaled by `mass_share` (1/N for a shared object of N peers).
/// Destruction restores mass, inertia, gravity, damping and activation, unless the host has set
/// them since. A body that slept and has moved since stays awake. The body and its world must
/// outlive this object. After its removal from the world (isInWorld) the body is neither read nor
/// written; its mass share stays.
///
/// Hand-off mode: takeHostChanges() in the pre-tick, then handOff() with the island's state at the
/// end of the step, and restore() in the post-tick. Impulse mode: applyWrench() in the pre-tick.
/// Between handOff() and restore() Bullet's gyroscopic term is off, because the island has rotated
/// the body already. All functions except constructor and destructor are real-time safe. All are
/// for the thread that steps the world.
class HapticBody final : public HostBody {
 public:
  /// Throws tandem::Error if the body is not in the world, is static or kinematic, or has no mass.
  /// Also throws if `mass_share` is not in (0, 1].
  static void checkAttachable(const btDiscreteDynamicsWorld& world, const btRigidBody& body,
                              double mass_share = 1.0);

  /// Throws as checkAttachable() does.
  HapticBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double mass_share = 1.0,
             Sleep sleep = Sleep::kNever);
  ~HapticBody() override;

  [[nodiscard]] HapticBody* asRigid() noexcept override { return this; }
  [[nodiscard]] btRigidBody& body() const noexcept { return body_; }
  /// The body was deleted: the destructor restores nothing, not even a body made at its address.
  void noteDeletion() noexcept { is_gone_ = true; }
  [[nodiscard]] bool isInWorld() const noexcept override;
  [[nodiscard]] double mass() const noexcept;  ///< of this copy [kg]
  [[nodiscard]] double massShare() const noexcept { return mass_share_; }
  /// Pre-tick, after takeHostChanges(), of a body that is not parked: it is another part of the
  /// host's mass from now on, in (0, 1]. Its velocities stay.
  void setMassShare(double share) noexcept;
  /// Principal moments of this copy, in B [kg m^2]; 0 about an axis that Bullet keeps fixed.
  [[nodiscard]] Vec3 inertia() const noexcept;
  /// Bullet's factors of accelerations along and about the axes of W; 0 where the host's is no
  /// finite number >= 0.
  [[nodiscard]] Vec3 linearFactor() const noexcept;
  [[nodiscard]] Vec3 angularFactor() const noexcept;
  /// Weight of this copy as Bullet applies it, in W [N]; 0 along axes with zero linear factor.
  [[nodiscard]] Vec3 gravityForce() const noexcept override;
  [[nodiscard]] RigidState state() const noexcept override;  ///< present state of the btRigidBody
  /// Bullet's built-in damping d, v *= (1 - d)^dt, as the host set it last; it is off during this
  /// object's life.
  [[nodiscard]] double linearDamping() const noexcept;
  [[nodiscard]] double angularDamping() const noexcept;
  /// Ends a damping that a native model gave the body. Any other change counts as the host's.
  void endModelDamping() const noexcept;
  /// True if the host has not changed it since the start, nor made another body at its address. The
  /// body must be in its world.
  [[nodiscard]] bool isAsHeld() const noexcept { return BodyLook::at(body_) == look_; }

  /// Warnings for the user, one line each. They concern built-in damping that is off or stays on, a
  /// large collision margin, and native contact stiffness that the island ignores.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept override {
    return warnings_;
  }

  /// Pre-tick. Forces and torques by the host in this step (without gravity) times dt. Also changes
  /// of velocity and pose by the host since the last restore(), remember() or takeHostChanges().
  /// Non-finite changes are dropped. As in Bullet, forces on a sleeping body are lost, and its
  /// velocity counts once the host wakes it.
  [[nodiscard]] HostChange takeHostChanges(double dt) noexcept override;

  /// Pre-tick. Sets the velocities that carry the body to `end` in one step of dt [s], whatever
  /// forces Bullet is about to add. Wakes a sleeping body if `end` is too far from its rest
  /// position. `end` may hold impulses that Bullet's solver is foreseen to give: Bullet starts
  /// without them, and finds them itself. `foreseen` is their mean over the step: it led the body
  /// to `end`.
  void handOff(const RigidState& end, double dt, const Momentum& foreseen = {}) noexcept override;

  /// Post-tick. Returns the impulses of Bullet's solver (contact with moving neighbours, joints),
  /// the foreseen ones too, and how the pose that it led to differs from the `end` of handOff().
  /// Then sets pose and velocity to this `end`, in the order that keeps motion state and
  /// interpolation right.
  HostChange restore() noexcept override;

  /// Centre of mass while Bullet's solver acted in the last step, in W [m].
  [[nodiscard]] const Vec3& solvedAt() const noexcept { return handed_.p_W_start; }
  /// Pre-tick, after handOff(). Velocity of the point at `arm_W` from the centre [m] that Bullet's
  /// solver starts with, in W [m/s].
  [[nodiscard]] Vec3 computeExpectedVelocity(const Vec3& arm_W) const noexcept;
  /// The same of the velocity that handOff() took out as foreseen: the solver is to give it back.
  [[nodiscard]] Vec3 computeForeseenVelocity(const Vec3& arm_W) const noexcept;

  /// Angular momentum of a turning body, in W [N m s]. Knows no factors.
  [[nodiscard]] Vec3 computeAngularMomentum(const Quat& q_WB, const Vec3& w_W) const noexcept;

  /// Post-tick, after restore() or wakeIfHit(). Sets the state that the island made of the solver's
  /// change instead of the `end` of handOff().
  void place(const RigidState& state) noexcept override;

  /// True if `state` is that of the last handOff() within 1e-12 m (and 1e-12 of the quaternion). It
  /// must also be slower than 1e-9 m/s and rad/s. With Sleep::kAsHost a parked body stands until it
  /// must be woken.
  [[nodiscard]] bool standsAt(const RigidState& state) const noexcept override;

  /// Post-tick, after restore(). Puts a standing body to sleep in Bullet, without its weight for
  /// later sub-steps. It needs no handOff() and restore() until unpark() or wakeIfHit().
  void park() noexcept override;
  [[nodiscard]] bool isParked() const noexcept override { return parked_; }
  /// True if Bullet has the body asleep. Post-tick: false also for a parked body whose broadphase
  /// box overlaps that of an awake one.
  [[nodiscard]] bool isAsleep() const noexcept override { return !body_.isActive(); }

  /// Pre-tick. True if the host has put an awake body to sleep (ISLAND_SLEEPING), or has moved one
  /// since. Bullet itself puts none to sleep with Sleep::kNever.
  [[nodiscard]] bool wasPutToSleep() const noexcept;
  /// Pre-tick, if wasPutToSleep(). Stops the body as Bullet does, parked where it is. It misses
  /// changes of the world's gravity, and sleeps on when this object ends. Returns where it is.
  RigidState stop() noexcept;

  /// Pre-tick. False once the host has woken, moved, pushed or changed a parked body or its weight.
  [[nodiscard]] bool isUndisturbed() const noexcept override;
  /// True if the world's gravity changed since the body was parked: Bullet updates awake bodies
  /// only. unpark() makes up for it, unless the host has put it to sleep.
  [[nodiscard]] bool hasMissedWorldGravity() const noexcept override;

  /// Pre-tick. Wakes the body, with its weight for this step; takeHostChanges() and handOff() may
  /// follow.
  void unpark() noexcept override;

  /// Post-tick. If something hit a parked body, unparks it where it stood and returns true with the
  /// impulses in `change`. A body that Bullet woke only for an awake neighbour goes back to sleep.
  [[nodiscard]] bool wakeIfHit(HostChange& change) noexcept override;

  /// Pre-tick, impulse mode: applies the impulse of a force and torque over dt [s].
  void applyWrench(const Vec3& f_W, const Vec3& t_W, double dt) noexcept override;

  /// Adds momentum at once, whatever the factors: the island has applied them already.
  void addMomentum(const Vec3& linear_W, const Vec3& angular_W) noexcept override;

  /// Stores the present state, so that only later changes by the host are reported.
  void remember() noexcept override;

  /// The host has moved the body by `offset_W` [m], with all else in its world: that is no change.
  void shiftOrigin(const Vec3& offset_W) noexcept override;
  /// Puts the body where it was left, unless the host has moved it there. After shiftOrigin().
  void putBack() noexcept;

  /// Sets pose and velocity at once (for a body whose state is prescribed).
  void setState(const RigidState& state) noexcept override;

 private:
  struct Original {
    btScalar inverse_mass;
    btVector3 inverse_inertia;
    btVector3 weight;
    btScalar linear_damping, angular_damping;
    int activation_state;
    btScalar deactivation_time;
    btTransform pose;
    int world_index;
  };
  /// Data that handOff() leaves for restore().
  struct Handed {
    RigidState end;
    Vec3 p_W_start = Vec3::Zero();     // position when Bullet's solver acted
    Quat q_WB_start;                   // orientation then
    btVector3 expected_v, expected_w;  // velocities after the step if only known forces act
    btVector3 foreseen_v{0, 0, 0}, foreseen_w{0, 0, 0};  // taken out of the velocities handed off
    bool is_foreseen = false;                            // `end` holds impulses of Bullet's solver
    int flags = 0;
    bool pending = false;
    bool asleep = false;  // Bullet received no velocity
  };

  void scaleMass(double share) noexcept;
  void readShift(HostChange& change) const noexcept;
  void restoreMassProps();
  [[nodiscard]] bool wasAddedAnew() const noexcept;
  void takeDamping() noexcept;
  void replaceMissingWeight() noexcept;
  [[nodiscard]] bool hasLeftItsRest(const RigidState& state) const noexcept;
  void restoreActivation();
  void standStill() noexcept;
  void parkAt(const RigidState& at) noexcept;
  void layWeightDown() noexcept;
  void keepAwake() noexcept;
  void stayAwake(double dt) noexcept;
  [[nodiscard]] bool sleepsOn() noexcept;
  [[nodiscard]] bool hasWorldGravity() const noexcept;
  void setPoseAndVelocity(const RigidState& state) noexcept;

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  Sleep sleep_;
  mutable int world_index_;
  mutable bool was_away_ = false;  ///< out of its world, at a call of isInWorld()
  std::vector<std::string> warnings_;
  bool has_additional_damping_ = false;
  bool parked_ = false;
  bool is_stopped_ = false;   // parked: by its host
  bool slept_ = false;        // at the last pre-tick
  bool stays_awake_ = false;  // parked: it was DISABLE_DEACTIVATION
  RigidState rest_;           // pose at which it fell asleep
  double mass_share_;
  btScalar inverse_mass_;
  btVector3 weight_{0, 0, 0};  ///< by our computation, at the start [N]
  btVector3 inverse_inertia_;  // with the mass share
  Original original_;
  BodyLook look_;
  bool is_gone_ = false;
  Handed handed_;
  btTransform known_pose_;
  btVector3 known_v_, known_w_;
  btVector3 known_gravity_, known_world_gravity_;  // while parked
  BodyLook known_look_;
};

/// Switches Bullet's own contact between two objects off or back on, and drops their cached contact
/// points. Calls are counted: two times off needs two times on. The host's own filtering is
/// untouched. Only `keeper` stores the filter. If `other` leaves its world and is deleted,
/// keeper.setIgnoreCollisionCheck(&other, false) removes it. Not during collision detection;
/// pre-tick and post-tick are fine.
void filterNativeContact(btDiscreteDynamicsWorld& world, btCollisionObject& keeper,
                         btCollisionObject& other, bool filtered);

/// Largest stable step of semi-implicit Euler (force injection) for a spring-damper on a mass [s]:
///   dt < (2 / w) (sqrt(z^2 + 1) - z),  w = sqrt(K/m),  z = B / (2 m w)
/// Infinite for K = B = 0; 2 m / B for K = 0. Source: characteristic polynomial of the step map.
[[nodiscard]] double computeInjectionStepLimit(double stiffness, double damping,
                                               double mass) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
