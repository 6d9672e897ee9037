#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/coordination/coupling_settings.h"

#pragma GCC visibility push(default)
namespace tandem {

/// Watches the connection between one hand and all others as a network with a port at each hand:
/// none may get more energy out than others and itself have put in, and a tank.
///
///   available = tank + own + sum of reported >= 0
///
/// `own` is what this side has put in so far: its hand's work -f . dp and the work of what its own
/// world has besides (weight, the host's forces); each site reports it with its states. It is not
/// enough to look at one port: who pushes a passive hand along gives it energy for as long as that
/// goes on. As states are late, so is what they report, and both belong to each other.
///
/// Nothing is done while available >= band. Below, the force is multiplied by available / band, so
/// that what is left is spent ever more slowly and never runs out. A hand that pushes feels at
/// least 2 %, and debts count to one tank: an account that others have emptied fills again.
///
/// Plain value without a clock; real-time safe. After Hannaford and Ryu's passivity observer (IEEE
/// T-RA 18(1), 2002), with two ports and a share of the force in place of a damper.
class PassivityObserver {
 public:
  explicit PassivityObserver(const PassivitySettings& settings = {}) noexcept
      : settings_(settings), lowest_(settings.tank) {}

  /// This side has put in so much more [J]; negative: it got some out. What is not finite does not
  /// count.
  void addOwn(double energy) noexcept {
    if (!std::isfinite(energy)) return;
    overdrawn_ += std::max(0.0, -energy - std::max(0.0, available()));
    own_ += energy;
    settle();
  }
  /// Others have reported so much more [J].
  void addReported(double energy) noexcept {
    if (!std::isfinite(energy)) return;
    reported_ += energy;
    settle();
  }
  /// Something has put in what nobody can tell: at least the tank is there again, and counts as
  /// put in by this side.
  void refill() noexcept { own_ += std::max(0.0, settings_.tank - available()); }

  /// Put in by this side so far [J], to be reported.
  [[nodiscard]] double own() const noexcept { return own_; }
  /// What the hand may still get [J].
  [[nodiscard]] double available() const noexcept {
    return settings_.tank + own_ + reported_ - forgotten_;
  }
  /// The least that was ever available [J].
  [[nodiscard]] double lowest() const noexcept { return lowest_; }

  /// Got by the hand when nothing was left, in all [J]: it moves on while its force is held.
  [[nodiscard]] double overdrawn() const noexcept { return overdrawn_; }

  /// Share of the force to be rendered, 0 to 1, when all of it is about to give the hand `energy`
  /// over the coming tick [J]; negative if the hand is about to put in.
  [[nodiscard]] double computeShare(double energy) const noexcept;

 private:
  /// Neither heat nor debts last for ever: a hand that is muted for what others took must come
  /// back.
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
