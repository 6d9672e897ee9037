#pragma once

#include <string>
#include <vector>

#include "plot/run.h"

namespace tandem::demos::plot {

/// Runs that share every setting but the scheme: one run per scheme, in the order of
/// knownSchemes().
struct SchemeGroup {
  std::vector<const Run*> runs;
  std::string difference;  ///< settings that set it apart from its siblings; empty when alone

  [[nodiscard]] const Run& first() const { return *runs.front(); }
  /// The group's run of that scheme, or null.
  [[nodiscard]] const Run* find(std::string_view scheme) const;
};

/// Groups that share every setting but `device.damping`, by rising damping; at least two.
struct Sweep {
  std::vector<SchemeGroup> points;
  std::string difference;  ///< settings that set it apart from other sweeps of its kind

  [[nodiscard]] RunKind kind() const { return points.front().first().kind; }
};

/// How a report presents many runs. Every pointer is into the vector given to groupRuns().
struct Grouping {
  std::vector<SchemeGroup> cooperation;
  std::vector<SchemeGroup> contact;
  std::vector<SchemeGroup> playground;
  std::vector<Sweep> sweeps;
};

/// True if two runs were asked for the same; titles and folder names do not count.
[[nodiscard]] bool haveEqualSettings(const Run& a, const Run& b);

/// All settings but the scheme as one text, equal for runs that differ in nothing else.
[[nodiscard]] std::string describeWithoutScheme(const Run& run);

/// Sorts runs in virtual time into groups and sweeps by their settings alone; titles and folder
/// names do not count.
///
/// Of runs with equal settings the first given stands for all. Of the groups in a sweep only one
/// is listed with the groups as well, for a closer look: the one with the paper's settings, else
/// the first given.
[[nodiscard]] Grouping groupRuns(const std::vector<Run>& runs);

}  // namespace tandem::demos::plot
