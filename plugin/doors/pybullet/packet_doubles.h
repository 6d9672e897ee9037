#pragma once

#include <vector>

#include "tandem/tandem.h"

namespace tandem::pybullet {

/// Converts a packet to the format of push and pop: sender, is_idle, sequence, time, position (3),
/// velocity (3), energy granted, energy holdings, number of objects. Each object follows with its
/// id and 13 numbers of its state.
std::vector<double> toDoubles(const TandemPacket& packet);

/// Converts such doubles to a packet. Throws Refusal if their number is wrong, or if an id or count
/// is not a whole number.
TandemPacket toPacket(const std::vector<double>& doubles);

}  // namespace tandem::pybullet
