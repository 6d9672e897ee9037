#pragma once

#include <cstdint>
#include <optional>

#include "coordination/src/island/island.h"
#include "site/detour.h"

namespace tandem {

/// What ties our copy of one shared object to one peer's: eqs (9), (10).
struct Tie {
  CouplerIndex coupler = 0;
  RigidState theirs;                      ///< the peer's copy as heard last
  Detour detour;                          ///< on which the coupler's target is led there
  std::optional<std::uint64_t> sequence;  ///< of the packet that brought it
  double velocity_share = 1.0;            ///< by which silence has slowed the target down

  /// The state that the coupler pulls to.
  [[nodiscard]] RigidState computeTarget() const noexcept {
    RigidState target = detour.apply(theirs);
    target.v_W *= velocity_share;
    target.w_W *= velocity_share;
    return target;
  }
};

}  // namespace tandem
