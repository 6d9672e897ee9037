#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "tandem/coordination/link.h"

namespace tandem {

/// Moves energy between this site's account and one peer's, so that each joule is at one place:
///
///   here, at the peer, or on its way.
///
/// A grant is deducted here before it is sent, and reports carry the sum of all grants. So lost,
/// late, repeated and overtaken packets make no energy. Both sides even out what they hold, but
/// neither gives its tank away. Plain value; real-time safe.
class EnergyLedger {
 public:
  /// Takes the peer's newest report. Returns the energy that it granted since the one before [J].
  /// The first report only says where the sum stands. A sum that fell belongs to a peer that began
  /// anew.
  [[nodiscard]] double hear(const EnergyReport& report) noexcept {
    const double more = heard_ ? std::max(0.0, report.granted - *heard_) : 0.0;
    heard_ = report.granted;
    theirs_ = report.holdings;
    return more;
  }

  /// The peer has restarted: its next report is a first one.
  void beginAnew() noexcept { heard_.reset(); }

  /// Grants the peer its part of what this site holds above its tank: half the difference between
  /// two sites, and less for each of several. Returns the energy to deduct here [J].
  [[nodiscard]] double grant(double available, double tank, int sites) noexcept {
    if (!heard_) return 0.0;
    const double excess = (available - theirs_ - granted_) / sites;
    const double above_tank = (available - tank) / (sites - 1);
    // Sums of such multiples are exact, so that both sides count the same.
    const double amount = std::floor(std::min(excess, above_tank) / kQuantum) * kQuantum;
    if (!(amount > 0.0) || granted_ + amount > kMost) return 0.0;
    granted_ += amount;
    return amount;
  }

  /// The report to the peer, once what was granted is deducted from `available` [J].
  [[nodiscard]] EnergyReport report(double available) const noexcept {
    return {granted_, std::clamp(available - heard_.value_or(0.0), -kMost, kMost)};
  }

 private:
  static constexpr double kQuantum = 1.0 / (1 << 30);  ///< [J]
  static constexpr double kMost = 1e9;                 ///< limit of the wire [J]

  double granted_ = 0.0;         ///< to the peer so far [J]
  std::optional<double> heard_;  ///< granted by the peer so far, by its newest report [J]
  double theirs_ = 0.0;          ///< the peer's holdings, by its newest report [J]
};

}  // namespace tandem
