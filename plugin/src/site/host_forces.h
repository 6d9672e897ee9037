#pragma once

#include "bullet_bridge/src/arms/pay_window.h"
#include "site/bodies.h"
#include "site/energy_port.h"
#include "site/host_clock.h"
#include "site/timeline.h"

namespace tandem {

/// Replaces momentum that is only rounding by zero.
[[nodiscard]] Vec3 dropRounding(const Vec3& momentum) noexcept;

/// Applies the host's forces and impulses to the bodies of the island.
///
/// An impulse acts at once. An even force acts over the host's step. If the ticks of that step have
/// run already, it acts over the next step, delayed by the host's lateness. A force that differs
/// from the one of the step before may follow the body's motion, as a spring does. All of it acts
/// at the start of the host's step, as in Bullet: spread over the step, or late, it would feed the
/// motion.
///
/// Ticks and host steps do not end together, so an account keeps the momentum that is still owed. A
/// steady force stays steady, and momentum is neither lost nor made. Without news from the host its
/// forces end. For the thread that ticks; real-time safe.
class HostForces {
 public:
  HostForces(Island& island, Timeline& timeline, const HostClock& clock, const Bodies& bodies,
             EnergyPort& energy) noexcept
      : island_(island), timeline_(timeline), clock_(clock), bodies_(bodies), energy_(energy) {}

  /// Sets the weight of a body as its only force. Zero for a body that Bullet moves.
  void setWeight(SiteBody& body, const Vec3& f_gravity_W) noexcept;
  /// Applies weight and host forces again, after the island's body was replaced.
  void renew(const SiteBody& body) noexcept;

  /// Takes the host's changes for its step of `dt`, which has just begun. `is_behind`: the ticks of
  /// this step have not run yet.
  void pass(double dt, bool is_behind) noexcept;
  /// Time over which forces of that step act from now on, and the ticks in which they are paid [s].
  [[nodiscard]] PayWindow findWindow(double dt, bool is_behind) const noexcept;
  /// Takes what Bullet's solver did to the bodies in the host step of `dt` that has ended: momentum
  /// that was not foreseen, the poses that it led to, and the forces that go on.
  void takeReactions(double dt) noexcept;
  /// Ends the force that goes on.
  void forgetForesight(SiteBody& body) noexcept;
  /// Momentum that was given for Bullet's solver in the host step up to `end` [s].
  [[nodiscard]] Foresight::Given takeForeseen(SiteBody& body, double end) noexcept {
    return body.load.foresight.take(clock_.time(), end);
  }
  /// The host has stopped a body: no force acts on it, its weight neither, and it is owed nothing.
  void stop(SiteBody& body) noexcept;
  /// Gives a body momentum from the host's side, at once.
  void give(SiteBody& body, const Momentum& momentum) noexcept;
  /// Momentum that the host's body still lacks: impulses that reached the island after the host's
  /// time, and host forces not yet applied.
  [[nodiscard]] Momentum computeOwed(const SiteBody& body) noexcept;
  /// The host's body has caught up: drops late momentum that its state now contains.
  void forgetLate(SiteBody& body) noexcept;

  /// Books the momentum that the island received since the last call.
  void settle() noexcept;
  /// Books nothing for the time since the last call: the island slept, or time was lost.
  void skip() noexcept { settled_ = timeline_.time(); }

  /// When the forces end [s], if after the island's time; else kNever.
  [[nodiscard]] double nextEnd() const noexcept {
    return end_ > timeline_.time() + kSameTime ? end_ : kNever;
  }
  /// True if they have ended now.
  bool endIfDue() noexcept {
    if (!are_on_ || timeline_.time() < end_ - kSameTime) return false;
    end();
    return true;
  }

 private:
  void end() noexcept;
  [[nodiscard]] Wrench takeEvenPart(SiteBody& body, double dt) const noexcept;
  void push(const SiteBody& body, const Momentum& momentum) noexcept;
  void giveImpulses(double dt) noexcept;
  void takeForces(SiteBody& body, const PayWindow& window) noexcept;
  void giveGifts() noexcept;
  [[nodiscard]] bool hasChanged(const SiteBody& body) const noexcept;
  void noteLate(SiteBody& body, const Momentum& momentum) noexcept;
  void moveOn(SiteBody& body, const HostChange& shift) noexcept;
  void expect(SiteBody& body, double dt) noexcept;
  void setWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept;

  Island& island_;
  Timeline& timeline_;
  const HostClock& clock_;
  const Bodies& bodies_;
  EnergyPort& energy_;
  double end_ = 0.0;      ///< when the forces end without news from the host [s]
  bool are_on_ = false;   ///< the forces have not ended yet
  double settled_ = 0.0;  ///< island time up to which momentum is booked [s]
};

}  // namespace tandem
