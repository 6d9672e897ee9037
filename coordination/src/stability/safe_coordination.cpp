#include "tandem/coordination/safe_coordination.h"

#include <algorithm>
#include <cmath>

#include "tandem/coordination/stability_advice.h"

#include "stability/loop_checks.h"

namespace tandem {
namespace {

constexpr double kLeastStiffness = 5.0, kMostStiffness = 20000.0;  // searched [N/m]
constexpr double kLeastDamping = 0.5, kMostDamping = 50.0;         // searched [N s/m]
constexpr double kStiffnessMargin = 2.0, kDampingMargin = 1.5;
constexpr double kCalmsIn = 50.0;      // delays, at most, to 1/e
constexpr double kLeastCalmed = 0.02;  // a shorter delay counts as this [s]
constexpr double kPrecision = 1.03;    // of a stiffness, as a factor
constexpr int kDampings = 7;           // tried in a round

/// Two digits, downwards.
double roundDown(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit + 1e-6) * unit;
}

/// Tries gains of one cooperation.
class Search {
 public:
  Search(const LoopSettings& settings, const GivenCoordination& given)
      : settings_(settings), given_(given) {}

  [[nodiscard]] double rateAt(const CouplerGains& gains, double later = 0.0) const {
    LoopSettings there = settings_;
    there.coordination = gains;
    there.delay = std::clamp(there.delay + later, 0.0, kLongestDelay);
    return computeWorstRate(there);
  }

  /// The stiffest that is safe; empty if none is. Searches around the best damping, twice.
  [[nodiscard]] std::optional<CouplerGains> findStiffest() const {
    if (given_.damping) return findStiffest(*given_.damping);
    double from = kLeastDamping, to = kMostDamping;
    std::optional<CouplerGains> best;
    for (int round = 0; round < 2; ++round) {
      const double step = std::pow(to / from, 1.0 / (kDampings - 1));
      for (int i = 0; i < kDampings; ++i) {
        const auto found = findStiffest(roundDown(from * std::pow(step, i)));
        if (found && (!best || found->stiffness > best->stiffness)) best = found;
      }
      if (!best) return std::nullopt;
      from = best->damping / step;
      to = best->damping * step;
    }
    return best;
  }

  /// The least unstable of a few.
  [[nodiscard]] CouplerGains findCalmest() const {
    CouplerGains calmest;
    double least = HUGE_VAL;
    const auto offer = [&](const CouplerGains& gains) {
      const double rate = rateAt(gains);
      if (rate >= least) return;
      least = rate;
      calmest = gains;
    };
    for (double K = kLeastStiffness; K < 2000.0; K *= 2.0)
      for (double B = kLeastDamping; B < 100.0; B *= 2.0)
        offer({given_.stiffness.value_or(roundDown(K)), given_.damping.value_or(roundDown(B))});
    return calmest;
  }

 private:
  [[nodiscard]] bool isSafe(const CouplerGains& gains) const {
    const double K = gains.stiffness, B = gains.damping;
    const double half = 0.5 / settings_.packet_rate;
    const double wanted = -1.0 / (kCalmsIn * std::max(settings_.delay + half, kLeastCalmed));
    return rateAt(gains) < wanted && rateAt({kStiffnessMargin * K, B}) < 0.0 &&
           rateAt({K, kDampingMargin * B}) < 0.0 && rateAt({K, B / kDampingMargin}) < 0.0 &&
           rateAt(gains, half) < 0.0 && rateAt(gains, -half) < 0.0;
  }

  /// The stiffest with a damping: halves from above, then bisection.
  [[nodiscard]] std::optional<CouplerGains> findStiffest(double damping) const {
    if (given_.stiffness) {
      const CouplerGains gains{*given_.stiffness, damping};
      return isSafe(gains) ? std::optional(gains) : std::nullopt;
    }
    double low = kMostStiffness;
    while (!isSafe({low, damping}))
      if ((low /= 2.0) < kLeastStiffness) return std::nullopt;
    for (double high = 2.0 * low; high > kPrecision * low;) {
      const double middle = std::sqrt(low * high);
      (isSafe({middle, damping}) ? low : high) = middle;
    }
    return CouplerGains{roundDown(low), damping};
  }

  LoopSettings settings_;
  GivenCoordination given_;
};

}  // namespace

SafeCoordination chooseCoordination(const LoopSettings& settings, const GivenCoordination& given) {
  stability::checkLoop(settings);
  const Search search(settings, given);
  SafeCoordination chosen;
  std::optional<CouplerGains> gains = search.findStiffest();
  chosen.is_for_empty_hands = gains.has_value();
  if (!gains) {
    LoopSettings held = settings;
    held.hand = kHeldHand;
    gains = Search(held, given).findStiffest();
  }
  chosen.gains = gains ? *gains : search.findCalmest();
  chosen.rate = search.rateAt(chosen.gains);
  return chosen;
}

}  // namespace tandem
