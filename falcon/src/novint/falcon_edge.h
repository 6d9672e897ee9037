#pragma once

#include "novint/falcon_kinematics.h"

namespace tandem {

/// Share (0 to 1) of `torques` that gives the grip at most `most` [N] here and wherever it may be
/// within `way` [m]. Near the end of a leg's reach a torque gives any force, as a toggle press
/// does: 0 if a leg ends within `way`. Pure; real-time safe.
[[nodiscard]] double computeEdgeShare(const FalconKinematics& kinematics, const FalconPose& pose,
                                      const Vec3& torques, double way, double most) noexcept;

}  // namespace tandem
