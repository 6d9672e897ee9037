#pragma once

#include <string>
#include <vector>

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include "tandem/coordination/types.h"

class btDiscreteDynamicsWorld;

#pragma GCC visibility push(default)
namespace tandem {

/// What the host or its solver did to a body behind the island's back.
struct HostChange {
  Vec3 impulse_W = Vec3::Zero();          ///< linear momentum given [N s]
  Vec3 angular_impulse_W = Vec3::Zero();  ///< angular momentum about the centre of mass [N m s]
  Vec3 f_W = Vec3::Zero();             ///< the part of it that is a force over the whole step [N]
  Vec3 t_W = Vec3::Zero();             ///< the same of the torque [N m]; the rest was given at once
  bool moved = false;                  ///< the host set a new pose
  Vec3 offset_W = Vec3::Zero();        ///< by which it moved the centre of mass [m]
  Quat rotation_W = Quat::Identity();  ///< by which it turned the body, in W
};

/// Whether Bullet may put a held body to sleep.
enum class Sleep {
  kNever,   ///< activation as DISABLE_DEACTIVATION; a body that slept wakes, and all it touches
  kAsHost,  ///< as without us: asleep, it is put where the island has it, and wakes when that is
            ///< farther than Bullet's own boxes are off their rest, 50 um
};

/// A rigid body of the host's world whose motion the island decides.
///
/// While it lives: no built-in damping, asleep only while parked or as `sleep` says, mass and
/// inertia scaled by `mass_share` (1/N for a shared object of N peers). Destruction restores mass,
/// inertia, gravity, damping and activation as they were (a body that slept and has been moved
/// since is left awake), unless the host has set them otherwise since. The body and its world must
/// outlive this object. Taking the body out of the world is noticed (isInWorld): it is neither read
/// nor written from then on, so its mass share stays with it.
///
/// A step of the host in hand-off mode: takeHostChanges() in the pre-tick, handOff() with the
/// island's state at the end of the step, and restore() in the post-tick. In impulse mode:
/// applyWrench() in the pre-tick. Between handOff() and restore() Bullet's gyroscopic term is off:
/// the island has turned the body already. All functions but constructor and destructor are
/// real-time safe; all are for the thread that steps the world.
class HapticBody {
 public:
  /// Throws tandem::Error if the body is not in the world, is static or kinematic, or has no mass;
  /// or if `mass_share` is not in (0, 1].
  HapticBody(btDiscreteDynamicsWorld& world, btRigidBody& body, double mass_share = 1.0,
             Sleep sleep = Sleep::kNever);
  ~HapticBody();
  HapticBody(const HapticBody&) = delete;
  HapticBody& operator=(const HapticBody&) = delete;

  [[nodiscard]] btRigidBody& body() const noexcept { return body_; }
  [[nodiscard]] bool isInWorld() const noexcept;
  [[nodiscard]] double mass() const noexcept;  ///< of this copy [kg]
  /// Principal moments of this copy, in B [kg m^2]; 0 about an axis about which Bullet does not
  /// turn it.
  [[nodiscard]] Vec3 inertia() const noexcept;
  /// Weight of this copy as Bullet applies it, without the axes of a zero linear factor, in W [N].
  [[nodiscard]] Vec3 gravityForce() const noexcept;
  [[nodiscard]] RigidState state() const noexcept;  ///< as the btRigidBody has it now
  /// Built-in damping as Bullet understands it, v *= (1 - d)^dt, which is off while this lives: as
  /// the host set it last.
  [[nodiscard]] double linearDamping() const noexcept;
  [[nodiscard]] double angularDamping() const noexcept;
  /// True if mass and inertia are what they were at the start.
  [[nodiscard]] bool hasItsMass() const noexcept;

  /// One line each, about what a user should know: built-in damping that is off while attached or
  /// cannot be switched off, a collision margin that is large for the body's size, native contact
  /// stiffness that the island does not use.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// Pre-tick. Forces and torques that the host has applied for this step (gravity apart), times
  /// dt; and velocity and pose changed by the host since the last restore(), remember() or call of
  /// this. A change that is not finite is dropped. As in Bullet, forces on a body that sleeps are
  /// lost, and its velocity counts from when the host wakes it.
  [[nodiscard]] HostChange takeHostChanges(double dt) noexcept;

  /// Pre-tick. Gives Bullet the velocities that carry the body from where it is to `end` in one
  /// step of dt, whatever forces Bullet is about to add to it. A body that sleeps is woken if that
  /// is too far from its rest.
  void handOff(const RigidState& end, double dt) noexcept;

  /// Post-tick. Returns the impulses by which Bullet's solver changed the handed-off velocity
  /// (contact with moving neighbours), then sets pose and velocity to the `end` of handOff(), in
  /// the order that keeps motion state and interpolation right.
  HostChange restore() noexcept;

  /// True if `state` is where the last handOff() took the body, within 1e-12 m and as much of the
  /// quaternion, and it is slower than 1e-9 m/s and rad/s. A parked body that may sleep as the host
  /// says stands as long as it need not be woken.
  [[nodiscard]] bool standsAt(const RigidState& state) const noexcept;

  /// Post-tick, after restore(), for a body that stands: it sleeps in Bullet, and needs no
  /// handOff() and restore() until unpark() or wakeIfHit().
  void park() noexcept;
  [[nodiscard]] bool isParked() const noexcept { return parked_; }
  /// Post-tick: false also for a parked body with something awake so near that their boxes in
  /// Bullet's broadphase overlap.
  [[nodiscard]] bool isAsleep() const noexcept { return !body_.isActive(); }

  /// Pre-tick. False once the host has woken, moved, pushed or reweighed a parked body.
  [[nodiscard]] bool isUndisturbed() const noexcept;
  /// True if the world has got another gravity since the body was parked: Bullet tells it to those
  /// that are awake. unpark() makes up for it.
  [[nodiscard]] bool hasMissedWorldGravity() const noexcept;

  /// Pre-tick. The body is awake again, with its weight for this step; takeHostChanges() and
  /// handOff() may follow.
  void unpark() noexcept;

  /// Post-tick. If something has hit a parked body it is unparked where it stood: true, and
  /// `change` has the impulses. One that Bullet has woken only because something is awake nearby
  /// is put back to sleep.
  [[nodiscard]] bool wakeIfHit(HostChange& change) noexcept;

  /// Pre-tick, impulse mode: the impulse of a force and torque over dt.
  void applyWrench(const Vec3& f_W, const Vec3& t_W, double dt) noexcept;

  /// Takes the present state as known, so that only later changes by the host are reported.
  void remember() noexcept;

  /// Sets pose and velocity at once (a body that is what somebody says it is).
  void setState(const RigidState& state) noexcept;

 private:
  struct Original {
    btScalar inverse_mass;
    btVector3 inverse_inertia;
    btVector3 weight;
    btScalar linear_damping, angular_damping;
    int activation_state;
    btScalar deactivation_time;
    btTransform pose;
  };
  /// What handOff() leaves for restore().
  struct Handed {
    RigidState end;
    Quat q_WB_start;                   // orientation at which Bullet's solver acted
    btVector3 expected_v, expected_w;  // velocities after the step if nothing but known forces acts
    int flags = 0;
    bool pending = false;
    bool asleep = false;  // Bullet was given no velocity
  };

  void scaleMass(double share);
  void takeDamping() noexcept;
  void replaceMissingWeight() noexcept;
  [[nodiscard]] bool hasLeftItsRest(const RigidState& state) const noexcept;
  void restoreActivation();
  void standStill() noexcept;
  void keepAwake() noexcept;
  [[nodiscard]] bool sleepsOn() noexcept;
  [[nodiscard]] bool hasWorldGravity() const noexcept;
  void setPoseAndVelocity(const RigidState& state) noexcept;
  [[nodiscard]] Vec3 computeAngularMomentum(const Quat& q_WB, const Vec3& w_W) const noexcept;

  btDiscreteDynamicsWorld& world_;
  btRigidBody& body_;
  Sleep sleep_;
  mutable int world_index_;
  std::vector<std::string> warnings_;
  bool has_additional_damping_ = false;
  bool parked_ = false;
  bool slept_ = false;  // at the last pre-tick
  RigidState rest_;     // where it fell asleep
  btScalar inverse_mass_;
  btVector3 inverse_inertia_;  // with the mass share
  Original original_;
  Handed handed_;
  btTransform known_pose_;
  btVector3 known_v_, known_w_;
  btVector3 known_gravity_, known_world_gravity_;  // while parked
};

/// Switches Bullet's own contact between two objects off, and back on; what they have of cached
/// contact goes. Counts: filtered twice, it must be switched back on twice. Leaves the host's own
/// filtering alone. `keeper` alone remembers it: should the other leave its world and be deleted,
/// keeper.setIgnoreCollisionCheck(&other, false) makes it forget. Not during collision detection;
/// the pre-tick and post-tick are fine.
void filterNativeContact(btDiscreteDynamicsWorld& world, btCollisionObject& keeper,
                         btCollisionObject& other, bool filtered);

/// Largest step for which semi-implicit Euler (force injection) of a spring-damper on a mass is
/// stable [s]:
///   dt < (2 / w) (sqrt(z^2 + 1) - z),  w = sqrt(K/m),  z = B / (2 m w)
/// infinite for K = B = 0; 2 m / B for K = 0. Source: characteristic polynomial of the step map.
[[nodiscard]] double computeInjectionStepLimit(double stiffness, double damping,
                                               double mass) noexcept;

}  // namespace tandem
#pragma GCC visibility pop
