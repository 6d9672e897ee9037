#pragma once

#include <cstdint>
#include <optional>

#include "tandem/coordination/link.h"

#include "coordination/src/island/island.h"
#include "site/detour.h"
#include "site/motion_limit.h"

namespace tandem {

/// Couples our copy of one shared object to one peer's copy: eqs (9), (10).
struct Tie {
  CouplerIndex coupler = 0;
  RigidState theirs;                      ///< latest state of the peer's copy
  Detour detour;                          ///< of the coupler's target, after a silence
  std::optional<std::uint64_t> sequence;  ///< packet of that state
  std::optional<std::uint64_t> awaited;   ///< no force before this packet or a later one
  std::uint64_t heard_at = 0;             ///< Peer::packets_heard at that state
  ObjectEpoch epoch;                      ///< of that state; no force while ours is another one
  double velocity_share = 1.0;            ///< of the target's velocity; silence lowers it
  MotionLimit motion;                     ///< of the peer's copy

  /// The coupler's target.
  [[nodiscard]] RigidState computeTarget() const noexcept {
    RigidState target = detour.apply(theirs);
    target.v_W *= velocity_share;
    target.w_W *= velocity_share;
    return target;
  }
};

}  // namespace tandem
