#pragma once

#include <algorithm>
#include <cmath>

#include "tandem/falcon/mouse_device.h"

namespace tandem::test {

/// Reads `mouse` at 1 kHz from the tick `begin` [ms] up to `end`, with no force.
inline DeviceSample readFree(MouseDevice& mouse, int begin, int end) {
  DeviceSample sample;
  for (int tick = begin; tick <= end; ++tick) {
    sample = mouse.read(tick * 1e-3);
    mouse.write(Vec3::Zero());
  }
  return sample;
}

/// A wall beyond x = 0: a spring-damper that pushes towards -x and never pulls.
struct MouseWall {
  double stiffness = 1000.0;  // K_vc [N/m]
  double damping = 0.0;       // B_vc [N s/m]

  [[nodiscard]] Vec3 push(const PointState& hip) const {
    const double depth = hip.p_W.x();
    if (!(depth > 0.0)) return Vec3::Zero();
    return {-std::max(stiffness * depth + damping * hip.v_W.x(), 0.0), 0.0, 0.0};
  }
};

}  // namespace tandem::test
