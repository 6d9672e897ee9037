#pragma once

#include <optional>

#include "tandem/coordination/link.h"

namespace tandem::demos {

/// The sender's copy of an object, if the packet has it. With more objects than fit into one packet
/// they take turns.
[[nodiscard]] inline std::optional<RigidState> findObject(const StatePacket& packet, ObjectId id) {
  for (std::size_t i = 0; i < packet.object_count; ++i)
    if (packet.objects[i].id == id) return packet.objects[i].state;
  return std::nullopt;
}

}  // namespace tandem::demos
