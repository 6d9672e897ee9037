#include "world/scene_frame.h"

namespace tandem::demos {

SceneFrame makeSceneFrame(const Scenario& scenario) {
  const Vec3 x = Vec3::UnitX();
  if (scenario.axis == x) return {};
  // Opposite to x there is no unique shortest turn: turns about z, so that up stays up.
  if (scenario.axis == -x) return {Quat(0.0, 0.0, 0.0, 1.0)};
  return {Quat::FromTwoVectors(x, scenario.axis)};
}

Vec3 computeStart(const Scenario& scenario, const SceneFrame& frame, int site) {
  const Vec3& offset = scenario.hands[static_cast<std::size_t>(site)].start_offset;
  if (scenario.isWorld()) return frame.toWorld(offset);
  const double side = site == 0 ? -1.0 : 1.0;
  const double distance =
      scenario.site.proxy.radius + (scenario.hasObject() ? 0.5 * scenario.object_size : 0.0);
  return frame.toWorld(side * distance * Vec3::UnitX() + offset);
}

}  // namespace tandem::demos
