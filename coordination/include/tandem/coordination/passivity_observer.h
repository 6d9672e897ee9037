#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/coordination/coupling_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Energy that a force would give the hand over a tick if a share s of it were rendered:
/// s `linear` + s^2 `quadratic` [J]. The second term is the motion that the force itself causes.
struct TickEnergy {
  double linear = 0.0;     ///< negative if the hand puts energy in
  double quadratic = 0.0;  ///< >= 0
};

/// Limits the energy that a hand extracts from its site. A joule may be extracted by one hand only:
///
///   available = tank + hand + max(0, world) + received - granted >= 0
///
/// `hand` is the hand's work -f . dp so far and `world` that of its site's own world (weight, the
/// host's forces). What peers grant to each other is deducted before it is sent (EnergyLedger). So
/// all hands together never extract more than all put in, the worlds gave, and the tanks.
///
/// While available >= band, the force stays whole. Below, it is multiplied by available / band, so
/// the rest drains ever more slowly and never runs out. A hand that puts energy in feels at least
/// 2%, so that an empty account fills again. A world that has taken energy in all counts as zero:
/// the hand put that energy in, and the account stays a bound without it.
///
/// Plain value without a clock; real-time safe. After Hannaford and Ryu's passivity observer (IEEE
/// T-RA 18(1), 2002), with several ports and a scaled force in place of a damper.
class PassivityObserver {
 public:
  explicit PassivityObserver(const PassivitySettings& settings = {}) noexcept
      : settings_(settings), lowest_(settings.tank) {}

  /// Adds energy that the hand put in [J]; negative: it extracted some. Ignores non-finite values.
  void addHand(double energy) noexcept {
    if (std::isfinite(energy)) overdrawn_ += std::max(0.0, -energy - std::max(0.0, available()));
    add(energy, hand_);
  }
  /// Adds energy that the site's own world put in [J]; negative: it took some.
  void addWorld(double energy) noexcept { add(energy, world_); }
  /// Adds energy received from peers [J]; negative: granted to them.
  void addMoved(double energy) noexcept { add(energy, moved_); }
  /// Refills the tank after an input of unknown energy by the world.
  void refill() noexcept { refilled_ += std::max(0.0, settings_.tank - available()); }

  /// Energy that this side put in so far, hand and world [J].
  [[nodiscard]] double own() const noexcept { return hand_ + world_ + refilled_; }
  /// Energy the hand may still extract [J].
  [[nodiscard]] double available() const noexcept {
    return settings_.tank + hand_ + std::max(0.0, world_) + refilled_ + moved_ - forgotten_;
  }
  /// The least energy that was ever available [J].
  [[nodiscard]] double lowest() const noexcept { return lowest_; }

  /// Energy extracted while none was available [J]: a hand moves on while its force is held.
  [[nodiscard]] double overdrawn() const noexcept { return overdrawn_; }

  /// Share of the force to render in the coming tick, 0 to 1; `whole` is its energy at share 1.
  [[nodiscard]] double computeShare(const TickEnergy& whole) const noexcept;

 private:
  /// Adds finite energy to one of the sums, and limits what is stored: the rest has become heat.
  void add(double energy, double& sum) noexcept {
    if (!std::isfinite(energy)) return;
    sum += energy;
    const double now = available();
    lowest_ = std::min(lowest_, now);
    forgotten_ += std::max(0.0, now - settings_.tank - settings_.most);
  }

  PassivitySettings settings_;
  double hand_ = 0.0, world_ = 0.0, moved_ = 0.0, refilled_ = 0.0, forgotten_ = 0.0;
  double lowest_, overdrawn_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
