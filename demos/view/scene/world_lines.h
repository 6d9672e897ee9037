#pragma once

#include <vector>

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include "scene/draw_list.h"

namespace tandem::view {

/// Parts of a world that a picture shows besides its solids.
struct WorldDetails {
  bool joints = false;    ///< frames and limits of the constraints
  bool contacts = false;  ///< contact points, each as a short line along its normal
  bool bounds = false;    ///< the axis-aligned boxes of the collision search

  [[nodiscard]] bool any() const { return joints || contacts || bounds; }
};

/// Collects the lines that Bullet draws for the details, in Bullet's colours. Lines that do not end
/// near the world's origin, such as the bounds of a plane, are left out.
///
/// The world's own debug drawer is in its place again afterwards. Call it in the thread that steps
/// the world.
[[nodiscard]] std::vector<Line> collectWorldLines(btDiscreteDynamicsWorld& world,
                                                  const WorldDetails& details);

}  // namespace tandem::view
