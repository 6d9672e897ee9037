#pragma once

#include <algorithm>
#include <cstdint>

#include "tandem/coordination/link.h"

namespace tandem {

/// One packet in this many is sent while they are rare: one per kIdlePacketPeriod. `packet_rate`
/// in Hz.
[[nodiscard]] inline std::uint64_t computeIdleStride(double packet_rate) noexcept {
  return std::max<std::uint64_t>(static_cast<std::uint64_t>(packet_rate * kIdlePacketPeriod), 1);
}

}  // namespace tandem
