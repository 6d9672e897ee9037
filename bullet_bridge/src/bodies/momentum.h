#pragma once

#include "tandem/coordination/types.h"

namespace tandem {

/// Linear and angular momentum about a centre of mass, in W [N s, N m s].
struct Momentum {
  Vec3 linear_W = Vec3::Zero(), angular_W = Vec3::Zero();

  [[nodiscard]] bool isZero() const noexcept {
    return linear_W == Vec3::Zero() && angular_W == Vec3::Zero();
  }
};

}  // namespace tandem
