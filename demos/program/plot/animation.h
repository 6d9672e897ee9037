#pragma once

#include <string>

#include "plot/figure.h"
#include "plot/scene.h"

namespace tandem::demos::plot {

/// A moving picture of the scene at both sites, side by side, seen from above one side: one SVG
/// that needs nothing else (SMIL animation), loops, and shows the time.
[[nodiscard]] Figure animateScene(const Run& run, const SceneMotion& motion,
                                  const std::string& name);

}  // namespace tandem::demos::plot
