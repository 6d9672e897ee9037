#pragma once

#include <string>

#include "tandem/coordination/stability.h"

#include "support/random.h"

namespace tandem::test {

/// Settings of a cooperation by chance: any scheme, with the cube or without, gains around those
/// that sampling allows, rates of 60 to 1000 Hz, delays of 0 to 300 ms, hands that are free or hold
/// their devices (300 N/m, 5 N s/m), and 2, 3, 4 or 8 users by sum or average. Users without a cube
/// are two, as more of them cannot all touch each other on one line.
[[nodiscard]] LoopSettings drawLoop(Random& random);

/// In a few words: "RDP cube 2 sum 1000/130 Hz 50.0 ms held".
[[nodiscard]] std::string describe(const LoopSettings& settings);

/// All its gains, to run it again.
[[nodiscard]] std::string describeGains(const LoopSettings& settings);

}  // namespace tandem::test
