#pragma once

#include <string>
#include <vector>

#include "preload_config.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace tandem::preload {

/// The body that a config selects in the current world.
struct ObjectChoice {
  btRigidBody* body = nullptr;  ///< null: no body fits
  int index = 0;                ///< among the moving bodies, from 1
  int others = 0;               ///< number of further bodies that fit
  ShapeWords shape;
  double mass = 0.0;  ///< [kg]
  std::string name;   ///< "box 0.1 0.1 0.1, 0.2 kg"
};

/// Selects the first dynamic body, in the world's order, with the config's index, shape and mass.
/// Skips the bodies in `leave_alone`. Allocates.
[[nodiscard]] ObjectChoice chooseObject(const btDiscreteDynamicsWorld& world,
                                        const PreloadConfig& config,
                                        const std::vector<const void*>& leave_alone);

/// Lists all dynamic bodies of a world.
[[nodiscard]] std::vector<const void*> findMovingBodies(const btDiscreteDynamicsWorld& world);

/// Describes at most eight dynamic bodies of a world in one line: "1 box 0.1 0.1 0.1, 0.2 kg; 2
/// ...".
[[nodiscard]] std::string listObjects(const btDiscreteDynamicsWorld& world);

}  // namespace tandem::preload
