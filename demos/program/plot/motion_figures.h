#pragma once

#include <vector>

#include "plot/figure.h"
#include "plot/grouping.h"

namespace tandem::demos::plot {

/// Positions of users and copies, and the force on user 1, one column per scheme.
[[nodiscard]] Figure cooperationMotion(const SchemeGroup& group, const std::string& name);

/// Displacements along x, y and z of users and copies, and the forces on both users: one run that
/// moves in space.
[[nodiscard]] Figure spatialMotion(const Run& run, const std::string& name);

}  // namespace tandem::demos::plot
