#pragma once

#include <optional>

#include "tandem/coordination/link.h"
#include "tandem/plugin/site.h"

namespace tandem::demos {

/// The sender's copy of an object, if the packet has it. With more objects than fit into one packet
/// they take turns.
[[nodiscard]] inline std::optional<RigidState> findObject(const StatePacket& packet, ObjectId id) {
  for (std::size_t i = 0; i < packet.object_count; ++i)
    if (packet.objects[i].id == id) return packet.objects[i].state;
  return std::nullopt;
}

/// Of all other sites' copies of object 0, as last received, the one farthest from the own copy;
/// empty if none was received. The site must share an object. Between ticks.
[[nodiscard]] inline std::optional<RigidState> findFarthestCopy(const Site& site) {
  std::optional<RigidState> farthest;
  const auto measure = [&](const RigidState& copy) {
    return (copy.p_W - site.object(0).p_W).norm();
  };
  for (int remote = 0; remote < site.remoteCount(); ++remote) {
    const auto copy = findObject(site.latest(remote), 0);
    if (copy && (!farthest || measure(*copy) > measure(*farthest))) farthest = copy;
  }
  return farthest;
}

}  // namespace tandem::demos
