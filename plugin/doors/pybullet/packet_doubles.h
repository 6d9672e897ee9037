#pragma once

#include <vector>

#include "tandem/tandem.h"

namespace tandem::pybullet {

/// A packet as the commands push and pop carry it: sender, is_idle, sequence, time, position (3),
/// velocity (3), port_energy, number of objects, then of each its id and 13 numbers of its state.
std::vector<double> toDoubles(const TandemPacket& packet);

/// The packet of such doubles. Throws Refusal if there are not as many as they say, or ids and
/// counts are none.
TandemPacket toPacket(const std::vector<double>& doubles);

}  // namespace tandem::pybullet
