#pragma once

#include <vector>

#include "tandem/coordination/contact_geometry.h"

#include "island_model.h"

namespace tandem {

/// One contact that may push: a sphere body and another body, or a sphere body and an obstacle.
struct Touch {
  BodyIndex sphere = 0;
  BodyIndex other = 0;                 ///< meaningless with an obstacle
  const Obstacle* obstacle = nullptr;  ///< null: the other is a body
  CouplerGains gains;
  bool pushes = false;  ///< its mode over the present step
};

/// How a touch stands at one instant.
struct TouchState {
  SphereContact geometry;
  double overlap_rate = 0.0;  ///< [m/s]

  [[nodiscard]] double overlap() const { return -geometry.gap; }
};

/// States of all bodies, by index.
using States = std::vector<RigidState>;

[[nodiscard]] TouchState computeTouchState(const IslandModel& model, const Touch& touch,
                                           const States& states) noexcept;

/// [K overlap + B overlap_rate]+ of eqs (7), (8), (11), (12) [N].
[[nodiscard]] double computePush(const Touch& touch, const TouchState& state) noexcept;

/// Adds the force of size `push` to both partners.
void addPush(const IslandModel& model, const Touch& touch, const TouchState& state, double push,
             const States& states, std::vector<Wrench>& wrenches) noexcept;

/// Calls `visit` with every touch there could be: bodies in pairs, spheres on obstacles.
template <typename Visit>
void forEachTouch(const IslandModel& model, Visit visit) {
  for (const ModelContact& pair : model.contacts)
    visit(Touch{pair.sphere, pair.other, nullptr, pair.gains, false});
  if (!model.obstacles) return;
  for (BodyIndex b = 0; b < static_cast<BodyIndex>(model.bodies.size()); ++b) {
    if (!model.bodies[b].settings.feels_obstacles) continue;
    for (const Obstacle& obstacle : *model.obstacles)
      visit(Touch{b, b, &obstacle, model.settings.obstacle_contact, false});
  }
}

}  // namespace tandem
