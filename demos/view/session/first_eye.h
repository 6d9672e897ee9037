#pragma once

#include <numbers>

#include "scenario/scenario.h"
#include "scene/draw_list.h"
#include "world/scene_frame.h"

namespace tandem::view {

/// Where a picture of the scenario is seen from at first: from its camera, or behind the right
/// shoulder of a user (from 0), near enough for both hands and what they share to fill it. At the
/// other side of the scene it is turned round.
[[nodiscard]] inline Eye chooseFirstEye(const demos::Scenario& scenario, int user) {
  Eye eye;
  if (const demos::CameraScenario& camera = scenario.camera; camera.distance > 0.0) {
    eye.target_W = demos::makeSceneFrame(scenario).toWorld(camera.target);
    eye.distance = camera.distance;
    eye.azimuth = camera.azimuth + std::numbers::pi * (user % 2);
    eye.elevation = camera.elevation;
    return eye;
  }
  const double size = scenario.hasObject() ? scenario.object_size : 0.03;
  eye.target_W = 0.5 * size * scenario.axis;
  eye.distance = 0.14 + 5.0 * size;
  eye.azimuth = -1.9 + std::numbers::pi * (user % 2);
  eye.elevation = 0.6;
  return eye;
}

}  // namespace tandem::view
