#pragma once

#include <string>

#include "plot/figure.h"
#include "plot/scene.h"

namespace tandem::demos::plot {

/// The scene from above, shapes to scale, at the start, the middle and the end, one row per site;
/// lines are the ways of user and proxy until then.
[[nodiscard]] Figure topView(const Run& run, const SceneMotion& motion, const std::string& name);

}  // namespace tandem::demos::plot
