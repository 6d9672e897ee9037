#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// True if the host put an object elsewhere: a point of it moved farther in a step than peers feel
/// as a pull. `radius` is that of a sphere around it [m]. Pure; real-time safe.
[[nodiscard]] inline bool isTeleport(double way, const Quat& rotation_W, double radius) noexcept {
  constexpr double kTeleport = 0.05;  // [m]
  return way + rotation_W.angularDistance(Quat::Identity()) * radius >= kTeleport;
}

[[nodiscard]] inline bool isTeleport(const RigidState& from, const RigidState& to,
                                     double radius) noexcept {
  return isTeleport((to.p_W - from.p_W).norm(), to.q_WB * from.q_WB.conjugate(), radius);
}

}  // namespace tandem
