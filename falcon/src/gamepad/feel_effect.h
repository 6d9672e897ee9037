#pragma once

#include "tandem/coordination/types.h"
#include "tandem/falcon/event_port.h"

namespace tandem {

/// The effect that renders the force `f_D` [N] in the user's frame (x right, y up, z back), with
/// full strength at `max_force` [N]. Rumble tells the norm of the force, a stick's force its part
/// in the level plane. Level 0 below 1 % of the strength, and for a force that is not finite. Pure,
/// real-time safe.
[[nodiscard]] FeelEffect makeFeelEffect(Feel feel, const Vec3& f_D, double max_force) noexcept;

}  // namespace tandem
