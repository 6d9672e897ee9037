#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/exchange.h"

namespace tandem::demos {

/// A small force along one axis, and what came of it.
struct Push {
  std::string where;            ///< "away"
  Vec3 asked_W = Vec3::Zero();  ///< [N]
  Vec3 moved_W = Vec3::Zero();  ///< of the grip [m]
  std::optional<Vec3> felt_W;   ///< at an emulated grip [N]
  std::string fault;            ///< of an emulated one; empty: as it must be
};

/// Pushes along each axis in turn, both ways; `show` is told the force and the grip's way while it
/// is held. Fewer than six if asked to end.
using ShowPush = std::function<void(const Push&, double force, double way)>;
[[nodiscard]] std::vector<Push> pushEachWay(LiveDevice& device, double force, const Pause& pause,
                                            const ShowPush& show);

}  // namespace tandem::demos
