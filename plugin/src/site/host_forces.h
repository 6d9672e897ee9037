#pragma once

#include "site/bodies.h"
#include "site/energy_port.h"
#include "site/host_clock.h"
#include "site/timeline.h"

namespace tandem {

/// Zero for what is left of momentum by rounding.
[[nodiscard]] Vec3 dropRounding(const Vec3& momentum) noexcept;

/// What the host does to bodies of the island by forces and impulses.
///
/// An impulse acts at once. A force acts over the host's step, or over the next one if the ticks of
/// this step have been run already, and as much later as the host is late at its worst. The
/// island's ticks and the host's steps do not end together, so an account is kept of what is owed:
/// a steady force is steady, and no momentum is lost or made. Without news from the host its forces
/// end. For whoever ticks; real-time safe.
class HostForces {
 public:
  HostForces(Island& island, const Timeline& timeline, const HostClock& clock, const Bodies& bodies,
             EnergyPort& energy) noexcept
      : island_(island), timeline_(timeline), clock_(clock), bodies_(bodies), energy_(energy) {}

  /// The weight of a body, and nothing besides. A body that Bullet moves has none in the island.
  void setWeight(SiteBody& body, const Vec3& f_gravity_W) noexcept;
  /// What acts on a body acts again, after something else has changed it.
  void renew(const SiteBody& body) noexcept;

  /// What the host has told of its bodies for its step of `dt`, which has just begun. `is_behind`:
  /// the ticks of this step are still to come.
  void pass(double dt, bool is_behind) noexcept;
  /// Momentum from the host's side, at once.
  void give(SiteBody& body, const Momentum& momentum) noexcept;
  /// What the host's state of a body does not have yet. Momentum that reached the island later than
  /// the host's time, and the host's own force that has not reached it.
  [[nodiscard]] Momentum computeOwed(const SiteBody& body) noexcept;
  /// The host's states have now what was late until now.
  void forgetLate(SiteBody& body) noexcept;

  /// Books what the island has had since the last call.
  void settle() noexcept;
  /// Nothing acted since the last call: the island was still, or time was lost.
  void skip() noexcept { settled_ = timeline_.time(); }

  /// When the forces end [s], if that is after the island's time.
  [[nodiscard]] double nextEnd() const noexcept {
    return end_ > timeline_.time() + kSameTime ? end_ : kNever;
  }
  void endIfDue() noexcept {
    if (are_on_ && timeline_.time() >= end_ - kSameTime) end();
  }

 private:
  void end() noexcept;
  void setWrench(BodyIndex body, const Vec3& f_W, const Vec3& t_W) noexcept;

  Island& island_;
  const Timeline& timeline_;
  const HostClock& clock_;
  const Bodies& bodies_;
  EnergyPort& energy_;
  double end_ = 0.0;      ///< without news from the host its forces end then [s]
  bool are_on_ = false;   ///< they have not ended yet
  double settled_ = 0.0;  ///< island time up to which they are booked
};

}  // namespace tandem
