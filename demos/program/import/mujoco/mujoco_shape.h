#pragma once

#include <string>
#include <vector>

#include "import/mujoco/mujoco_model.h"
#include "scenario/body_scenario.h"
#include "world/rotation.h"

namespace tandem::demos {

/// Pose of a geom or of a body's principal axes in the start.
struct MujocoPose {
  Vec3 p_W;
  Mat3 R_W;
};

[[nodiscard]] MujocoPose poseOfGeom(const MujocoModel& world, int geom);

/// Form of a geom about its own origin. A mesh is its hull where it moves. Throws UsageError for
/// a height field.
[[nodiscard]] ShapeScenario makeShape(const MujocoModel& world, int geom, bool moves);

/// The geoms of a body that collide; all if none does.
[[nodiscard]] std::vector<int> findSolidGeoms(const mjModel& model, int body);

/// "#rrggbb" of the first of a body's geoms that has a colour of its own; else empty.
[[nodiscard]] std::string findColour(const mjModel& model, int body);

}  // namespace tandem::demos
