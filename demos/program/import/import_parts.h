#pragma once

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// A plane of another format becomes a box of this size [m], unless it has a size of its own.
inline constexpr double kGroundWidth = 2.0, kGroundThickness = 0.1;

/// Gives the body one form in place of one part, if that lies at the body's own place.
void joinOnlyPart(BodyScenario& body);

}  // namespace tandem::demos
