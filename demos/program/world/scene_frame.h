#pragma once

#include "tandem/coordination/types.h"

#include "scenario/scenario.h"

namespace tandem::demos {

/// The scene's own frame S of scenarios and results: x along the axis from user 1 to user 2, z up,
/// origin at the shared object's start. W is Bullet's world.
struct SceneFrame {
  Quat q_WS = Quat::Identity();
  [[nodiscard]] Vec3 toWorld(const Vec3& v_S) const { return q_WS * v_S; }
  [[nodiscard]] Vec3 toScene(const Vec3& v_W) const { return q_WS.conjugate() * v_W; }
};

[[nodiscard]] SceneFrame makeSceneFrame(const Scenario& scenario);

/// Start of a user's device in W [m]: the user's place, see computeUserPlace(), plus the scenario's
/// offset.
[[nodiscard]] Vec3 computeStart(const Scenario& scenario, const SceneFrame& frame, int site);

}  // namespace tandem::demos
