#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// True if two states are equal in all numbers. Pure; real-time safe.
[[nodiscard]] inline bool isSame(const RigidState& a, const RigidState& b) noexcept {
  return a.p_W == b.p_W && a.v_W == b.v_W && a.w_W == b.w_W && a.q_WB.coeffs() == b.q_WB.coeffs();
}

}  // namespace tandem
