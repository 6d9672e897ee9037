#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/coordination/coupling_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Limits the energy that a hand extracts from its connection to all others. The connection is a
/// network with one port per hand. A hand may extract the energy that all hands put in, plus a
/// tank:
///
///   available = tank + own + sum of reported >= 0
///
/// `own` is the energy this side put in so far: the hand's work -f . dp plus the work of its own
/// world (weight, the host's forces). Each site reports it with its states. One port alone is not
/// enough: a user who pushes a passive hand along feeds it energy for as long as the push lasts.
/// States and their reported energy are equally late, so they match.
///
/// While available >= band, the force stays whole. Below, it is multiplied by available / band, so
/// the rest drains ever more slowly and never runs out. A hand that puts energy in feels at least
/// 2%. Debts are limited to one tank, so an account that others emptied fills again.
///
/// Plain value without a clock; real-time safe. After Hannaford and Ryu's passivity observer (IEEE
/// T-RA 18(1), 2002), with two ports and a scaled force in place of a damper.
class PassivityObserver {
 public:
  explicit PassivityObserver(const PassivitySettings& settings = {}) noexcept
      : settings_(settings), lowest_(settings.tank) {}

  /// Adds energy that this side put in [J]; negative: it extracted some. Ignores non-finite values.
  void addOwn(double energy) noexcept {
    if (!std::isfinite(energy)) return;
    overdrawn_ += std::max(0.0, -energy - std::max(0.0, available()));
    own_ += energy;
    settle();
  }
  /// Adds energy that others reported [J].
  void addReported(double energy) noexcept {
    if (!std::isfinite(energy)) return;
    reported_ += energy;
    settle();
  }
  /// Refills the tank, as own energy, after an input of unknown energy.
  void refill() noexcept { own_ += std::max(0.0, settings_.tank - available()); }

  /// Energy this side put in so far [J], to be reported.
  [[nodiscard]] double own() const noexcept { return own_; }
  /// Energy the hand may still extract [J].
  [[nodiscard]] double available() const noexcept {
    return settings_.tank + own_ + reported_ - forgotten_;
  }
  /// The least energy that was ever available [J].
  [[nodiscard]] double lowest() const noexcept { return lowest_; }

  /// Energy extracted while none was available [J]: a hand moves on while its force is held.
  [[nodiscard]] double overdrawn() const noexcept { return overdrawn_; }

  /// Share of the force to render, 0 to 1. The full force would give the hand `energy` over the
  /// coming tick [J]; negative if the hand puts energy in.
  [[nodiscard]] double computeShare(double energy) const noexcept;

 private:
  /// Limits stored energy and debts, so that a hand muted by what others extracted recovers.
  void settle() noexcept {
    const double now = available();
    lowest_ = std::min(lowest_, now);
    forgotten_ += now - std::clamp(now, -settings_.tank, settings_.tank + settings_.most);
  }

  PassivitySettings settings_;
  double own_ = 0.0, reported_ = 0.0, forgotten_ = 0.0;
  double lowest_, overdrawn_ = 0.0;
};

}  // namespace tandem
#pragma GCC visibility pop
