#pragma once

#include <numbers>

#include "scenario/scenario.h"
#include "scene/draw_list.h"

namespace tandem::view {

/// Where a picture of the scenario is seen from at first: behind the right shoulder of user 0 or 1,
/// near enough for both hands and what they share to fill it.
[[nodiscard]] inline Eye chooseFirstEye(const demos::Scenario& scenario, int user) {
  const double size = scenario.hasObject() ? scenario.object_size : 0.03;
  Eye eye;
  eye.target_W = 0.5 * size * scenario.axis;
  eye.distance = 0.14 + 5.0 * size;
  eye.azimuth = -1.9 + std::numbers::pi * user;
  eye.elevation = 0.6;
  return eye;
}

}  // namespace tandem::view
