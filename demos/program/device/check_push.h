#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/exchange.h"

namespace tandem::demos {

/// A small force along one axis, and its effect.
struct Push {
  std::string where;            ///< "away"
  Vec3 asked_W = Vec3::Zero();  ///< commanded force [N]
  Vec3 moved_W = Vec3::Zero();  ///< way of the grip [m]
  std::optional<Vec3> felt_W;   ///< force at an emulated grip [N]
  std::string fault;            ///< fault of an emulated device; empty: none
};

/// Pushes along each axis in turn, both ways. Calls `show` with the force and the grip's way during
/// each push. Fewer than six pushes if asked to end.
using ShowPush = std::function<void(const Push&, double force, double way)>;
[[nodiscard]] std::vector<Push> pushEachWay(LiveDevice& device, double force, const Pause& pause,
                                            const ShowPush& show);

}  // namespace tandem::demos
