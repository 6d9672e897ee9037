#pragma once

#include <string>

#include "plot/projection.h"
#include "plot/smil.h"

namespace tandem::demos::plot {

/// One body of an animated picture: an SVG group with that id whose parts move by themselves.
///
/// A ball or a box that only travels is one shape that is shifted. A box that turns is its faces:
/// of a convex body the faces turned to the viewer never hide each other, and those turned away
/// shrink to a point, so no order among them is needed.
[[nodiscard]] std::string drawMovingBody(const SceneBody& body, const std::vector<Pose>& poses,
                                         const Projection& projection, const LoopClock& clock,
                                         const std::string& id);

/// The outline of a ball, to be drawn above everything: a user behind a box is still seen.
[[nodiscard]] std::string drawMovingOutline(const SceneBody& body, const std::vector<Pose>& poses,
                                            const Projection& projection, const LoopClock& clock);

}  // namespace tandem::demos::plot
