#pragma once

#include "tandem/coordination/passivity_observer.h"

#include "site/site_body.h"

namespace tandem {

class Timeline;

/// The account of what this site puts into the connection (PassivityObserver):
///
///   the hand             -f . dp, the force as rendered, over each tick: exact, as it is held
///   weight, host forces  f . dp + t . w dt of the bodies that the island moves
///   impulses             J . (v + v') / 2: the host's, and of contact with bodies that Bullet
///   keeps neighbours           their kinetic energy when the island takes them, and gives them
///   back
///
/// What the host moves by hand, a kinematic body or a body put elsewhere, has no measure: it fills
/// the tank. Where Bullet moves the bodies nobody knows what it did to them: there is no account
/// then, and packets say so. Real-time safe.
class EnergyPort {
 public:
  /// `island_moves`: the bodies are the island's, so the account can be kept.
  EnergyPort(const PassivitySettings& settings, bool island_moves) noexcept
      : observer_(settings), is_kept_(settings.enabled && island_moves) {}

  [[nodiscard]] const PassivityObserver& observer() const noexcept { return observer_; }
  [[nodiscard]] bool isKept() const noexcept { return is_kept_; }
  /// Ticks in which the hand was about to get too much.
  [[nodiscard]] std::uint64_t limitedCount() const noexcept { return limited_; }

  /// The hand went so far while this force was rendered.
  void countHand(const Vec3& f_W, const Vec3& way_W) noexcept { observer_.addOwn(-f_W.dot(way_W)); }
  /// Some force of the world acts on some body: its work counts from now on.
  void noteWorldForce() noexcept { world_pushes_ = true; }
  /// Work of the world's forces over the tick that has just been run.
  void countWorld(const Island& island, const Timeline& timeline) noexcept;
  void countImpulse(const RigidState& before, const RigidState& after,
                    const Momentum& impulse) noexcept;
  /// A neighbour comes with its kinetic energy (`sign` 1) or takes it along (-1).
  void countNeighbour(const IslandBody& body, const RigidState& state, double sign) noexcept;
  /// The host has moved something by hand.
  void refill() noexcept { observer_.refill(); }
  /// A peer has put in so much more [J].
  void addReported(double energy) noexcept { observer_.addReported(energy); }

  /// The force that a hand of velocity `v_W` may get over `duration` [s].
  [[nodiscard]] Vec3 limit(const Vec3& wanted_W, const Vec3& v_W, double duration) noexcept;

 private:
  PassivityObserver observer_;
  bool is_kept_;
  bool world_pushes_ = false;
  std::uint64_t limited_ = 0;
};

}  // namespace tandem
