#include "world/scene_frame.h"

#include "scenario/user_places.h"

namespace tandem::demos {

SceneFrame makeSceneFrame(const Scenario& scenario) {
  const Vec3 x = Vec3::UnitX();
  if (scenario.axis == x) return {};
  // Opposite to x there is no unique shortest turn: turns about z, so that up stays up.
  if (scenario.axis == -x) return {Quat(0.0, 0.0, 0.0, 1.0)};
  return {Quat::FromTwoVectors(x, scenario.axis)};
}

Vec3 computeStart(const Scenario& scenario, const SceneFrame& frame, int site) {
  const auto at = static_cast<std::size_t>(site);
  return frame.toWorld(computeUserPlace(scenario, at) + scenario.sites[at].hand.start_offset);
}

}  // namespace tandem::demos
