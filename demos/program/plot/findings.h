#pragma once

#include <functional>
#include <string>
#include <vector>

#include "plot/grouping.h"

/// \file
/// What the numbers say, in words. Everything is computed from the runs; the only thing known
/// beforehand is which order the paper reports.
namespace tandem::demos::plot {

/// One way to measure how far apart the two copies of the object are.
struct CoherencyMeasure {
  std::string name;                         ///< "at equal time"
  std::function<double(const Run&)> value;  ///< [m]
};

/// At equal time, as received at site 1, as received at site 2.
[[nodiscard]] const std::vector<CoherencyMeasure>& coherencyMeasures();

/// How the schemes of a group rank by one measure.
struct SchemeOrder {
  std::vector<const Run*> worst_first;
  std::string text;  ///< "virtual coupling (10.9 mm) > remote dynamic proxy (6.31 mm) > …"
  bool is_complete = false;    ///< all three schemes are there, with a value each
  bool is_the_papers = false;  ///< virtual coupling worst, kinematic proxy best
};

[[nodiscard]] SchemeOrder orderSchemes(const SchemeGroup& group, const CoherencyMeasure& measure);

/// Contact that is made and lost at least this often is called intermittent.
inline constexpr double kIntermittentChanges = 20;

/// "no contact", "kept after the first touch", "intermittent" or "bounces".
[[nodiscard]] std::string contactVerdict(double transitions);

/// "1 change", "23 changes".
[[nodiscard]] std::string changesText(double transitions);

/// Sentences on a whole sweep: where the paper's order holds, or where contact is kept.
[[nodiscard]] std::vector<std::string> sweepFindings(const Sweep& sweep);

}  // namespace tandem::demos::plot
