#pragma once

#include "tandem/coordination/stability.h"

namespace tandem::stability {

/// Throws std::invalid_argument that names the first setting out of range.
void checkLoop(const LoopSettings& settings);

/// The same for a part of a packet period, 0 to 1.
void checkPhase(double phase);

}  // namespace tandem::stability
