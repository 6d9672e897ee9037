#pragma once

#include <cstdint>
#include <vector>

#include "bench/stress/stress_case.h"

namespace tandem::demos::bench {

/// Compares a case of kind kPaper with the solver of the paper's equations, which shares no code
/// with the library. Stable or not, both must agree.
///
/// Bouncing contact multiplies any difference at each impact. So the comparison ends after
/// kMostChanges begins and ends of contact.
class PaperCheck {
 public:
  static constexpr int kMostChanges = 4;

  /// Solves the case. Throws std::invalid_argument for a case of another kind.
  explicit PaperCheck(const StressCase& one);

  /// Compares the devices at the start of a tick; displacements along the axis [m].
  void compare(std::uint64_t tick, double x1, double x2);

  /// Largest difference over the largest displacement so far.
  [[nodiscard]] double worst() const { return worst_; }

 private:
  struct Row {
    double x1, x2;
  };
  std::vector<Row> rows_;  ///< rows to be compared
  double largest_ = 0.0, worst_ = 0.0;
};

}  // namespace tandem::demos::bench
