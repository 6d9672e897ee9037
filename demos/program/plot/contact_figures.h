#pragma once

#include <string>

#include "plot/figure.h"
#include "plot/grouping.h"

namespace tandem::demos::plot {

/// User-to-user contact as user 1 meets it, one column per scheme: positions, force, and a ribbon
/// that is filled while there is contact.
[[nodiscard]] Figure contactMotion(const SchemeGroup& group, const std::string& name);

}  // namespace tandem::demos::plot
