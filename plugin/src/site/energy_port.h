#pragma once

#include "tandem/coordination/passivity_observer.h"

#include "coordination/src/link/energy_ledger.h"
#include "site/site_body.h"

namespace tandem {

class Timeline;

// clang-format off
/// Accounts for the energy that this site's hand may get (PassivityObserver):
///
///   the hand             -f . dp of the rendered force over each tick; exact, as the force is held
///   weight, host forces  f . dp + t . w dt of the bodies that the island moves
///   impulses             J . (v + v') / 2 of the host, and of contact with bodies of Bullet
///   neighbours           their kinetic energy when they enter (+) and leave (-) the island
///   masses that change   as of a body that leaves, and one that enters
///   peers                what they grant to this site, and it to them (EnergyLedger)
///
/// A kinematic body, or a body that the host repositions, does unknown work and refills the tank.
/// Where Bullet moves the bodies their energy is unknown, so no account is kept and packets say so.
/// Such a peer counts as granting all it may, `power`.
/// Real-time safe.
// clang-format on
class EnergyPort {
 public:
  /// `island_moves`: the island moves the bodies, so the account can be kept.
  EnergyPort(const PassivitySettings& settings, bool island_moves) noexcept
      : settings_(settings), observer_(settings), is_kept_(settings.enabled && island_moves) {}

  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }
  [[nodiscard]] bool isKept() const noexcept { return is_kept_; }
  /// Number of ticks in which the force was reduced to limit the hand's energy.
  [[nodiscard]] std::uint64_t limitedCount() const noexcept { return limited_; }

  /// Adds the hand's work: it moved by `way_W` [m] while `f_W` [N] was rendered.
  void countHand(const Vec3& f_W, const Vec3& way_W) noexcept {
    observer_.addHand(-f_W.dot(way_W));
  }
  /// A force of the world acts on a body: countWorld() has work to do from now on.
  void noteWorldForce() noexcept { world_pushes_ = true; }
  /// Adds the work of the world's forces over the tick that has just run.
  void countWorld(const Island& island, const Timeline& timeline) noexcept;
  /// Adds the work of a lift by a hand that is elsewhere, or of the weight that this hand lifts
  /// elsewhere. All sites together count nothing.
  void countLift(double work) noexcept { observer_.addWorld(work); }
  void countImpulse(const RigidState& before, const RigidState& after,
                    const Momentum& impulse) noexcept;
  /// A neighbour enters the island with its kinetic energy (`sign` 1) or takes it away (-1).
  void countNeighbour(const IslandBody& body, const RigidState& state, double sign) noexcept;
  /// Refills the tank: the host moved something, with unknown work.
  void refill() noexcept { observer_.refill(); }

  /// Takes a peer's report; what it granted becomes available at no more than `power`.
  void hear(EnergyLedger& ledger, const EnergyReport& report) noexcept {
    waiting_ = std::min(waiting_ + ledger.hear(report), settings_.most);
  }
  /// Grants a peer its part of what is here; `sites` share it. Empty if no account is kept.
  [[nodiscard]] std::optional<EnergyReport> report(EnergyLedger& ledger, int sites) noexcept;
  /// Called once a tick: takes what peers granted. `keeps_all`: each peer keeps an account.
  void receive(double period, bool keeps_all) noexcept {
    if (waiting_ > 0.0 || !keeps_all) credit(settings_.power * period, keeps_all);
  }

  /// The share of `wanted_W` [N] that a hand of velocity `v_W` may get over `duration` [s], with a
  /// torque of the power `turning` [W]. Its velocity is expected to change by as much as `change_W`
  /// [m/s], in any direction.
  [[nodiscard]] double computeShare(const Vec3& wanted_W, double turning, const Vec3& v_W,
                                    const Vec3& change_W, double duration) noexcept;

 private:
  void credit(double most, bool keeps_all) noexcept;

  PassivitySettings settings_;
  PassivityObserver observer_;
  bool is_kept_;
  bool world_pushes_ = false;
  double waiting_ = 0.0;  ///< granted by peers, not yet available [J]
  std::uint64_t limited_ = 0;
};

}  // namespace tandem
