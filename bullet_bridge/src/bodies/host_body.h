#pragma once

#include <string>
#include <vector>

#include "tandem/coordination/types.h"

#include "bodies/momentum.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Changes that the host or its solver made to a body outside the island.
struct HostChange {
  Vec3 impulse_W = Vec3::Zero();          ///< linear momentum given [N s]
  Vec3 angular_impulse_W = Vec3::Zero();  ///< angular momentum about the centre of mass [N m s]
  Vec3 f_W = Vec3::Zero();                ///< part of it from a force over the whole step [N]
  Vec3 t_W = Vec3::Zero();                ///< part of it from a torque over the whole step [N m]
  bool moved = false;                     ///< the host set a new pose
  Vec3 offset_W = Vec3::Zero();           ///< displacement of the centre of mass [m]
  Quat rotation_W = Quat::Identity();     ///< rotation of the body, in W
};

[[nodiscard]] inline bool isFinite(const HostChange& change) noexcept {
  return change.f_W.allFinite() && change.t_W.allFinite() && change.impulse_W.allFinite() &&
         change.angular_impulse_W.allFinite() && change.offset_W.allFinite() &&
         change.rotation_W.coeffs().allFinite();
}

class HapticBody;

/// A moving body of the host's world, in Bullet's place of which the island decides the motion: a
/// rigid body (HapticBody), or a link of a multi-body (LinkBody).
///
/// Per step of the host: takeHostChanges() and handOff() in the pre-tick, restore() and perhaps
/// place() in the post-tick. All functions are real-time safe, and for the thread that steps the
/// world. After its removal from the world the body is neither read nor written.
class HostBody {
 public:
  virtual ~HostBody() = default;
  HostBody() = default;
  HostBody(const HostBody&) = delete;
  HostBody& operator=(const HostBody&) = delete;

  /// The same as a rigid body of its own; null: it is a link.
  [[nodiscard]] virtual HapticBody* asRigid() noexcept { return nullptr; }
  [[nodiscard]] virtual bool isInWorld() const noexcept = 0;
  /// Warnings for the user, one line each.
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const noexcept = 0;

  [[nodiscard]] virtual RigidState state() const noexcept = 0;  ///< Bullet's present one
  /// Weight as Bullet applies it, in W [N].
  [[nodiscard]] virtual Vec3 gravityForce() const noexcept = 0;

  /// Pre-tick. What the host did to the body since the last restore(), remember() or
  /// takeHostChanges(), and its forces in the coming step of `dt` [s] without gravity.
  [[nodiscard]] virtual HostChange takeHostChanges(double dt) noexcept = 0;
  /// Pre-tick. Lets Bullet carry the body to `end` in one step of dt [s]. `foreseen` is the mean
  /// over the step of impulses that led to `end`, and that Bullet's solver shall find itself.
  virtual void handOff(const RigidState& end, double dt,
                       const Momentum& foreseen = {}) noexcept = 0;
  /// Post-tick. Returns what Bullet's solver did beside this, and sets the body to `end`.
  virtual HostChange restore() noexcept = 0;
  /// Post-tick, after restore() or wakeIfHit(). Sets another state instead of the `end`.
  virtual void place(const RigidState& state) noexcept = 0;

  /// True if `state` is that of the last handOff(), and at rest.
  [[nodiscard]] virtual bool standsAt(const RigidState& state) const noexcept = 0;
  /// Post-tick, after restore(). Puts a standing body to sleep in Bullet, if that may be.
  virtual void park() noexcept = 0;
  [[nodiscard]] virtual bool isParked() const noexcept = 0;
  /// True if Bullet has the body asleep.
  [[nodiscard]] virtual bool isAsleep() const noexcept = 0;
  /// Pre-tick. False once the host has woken, moved, pushed or changed a parked body.
  [[nodiscard]] virtual bool isUndisturbed() const noexcept = 0;
  /// True if the world's gravity changed since the body was parked.
  [[nodiscard]] virtual bool hasMissedWorldGravity() const noexcept = 0;
  /// Pre-tick. Wakes the body; takeHostChanges() and handOff() may follow.
  virtual void unpark() noexcept = 0;
  /// Post-tick. If something hit a parked body, unparks it and returns true.
  [[nodiscard]] virtual bool wakeIfHit(HostChange& change) noexcept = 0;

  /// Adds momentum at once.
  virtual void addMomentum(const Vec3& linear_W, const Vec3& angular_W) noexcept = 0;
  /// Pre-tick, impulse mode: applies the impulse of a force and torque over dt [s].
  virtual void applyWrench(const Vec3& f_W, const Vec3& t_W, double dt) noexcept = 0;
  /// Stores the present state, so that only later changes by the host are reported.
  virtual void remember() noexcept = 0;
  /// Sets pose and velocity at once.
  virtual void setState(const RigidState& state) noexcept = 0;
  /// The host has moved the body by `offset_W` [m], with all else in its world: that is no change.
  virtual void shiftOrigin(const Vec3& offset_W) noexcept = 0;
};

}  // namespace tandem
#pragma GCC visibility pop
