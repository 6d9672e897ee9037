#pragma once

#include <string>
#include <vector>

#include "preload_config.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace tandem::preload {

/// What a config picks in a world as it is now.
struct ObjectChoice {
  btRigidBody* body = nullptr;  ///< null: it is not there
  int index = 0;                ///< of the moving bodies, from 1
  int others = 0;               ///< more bodies that the config's words fit
  ShapeWords shape;
  double mass = 0.0;  ///< [kg]
  std::string name;   ///< "box 0.1 0.1 0.1, 0.2 kg"
};

/// The first dynamic body, in the world's order, that has the config's index, shape and mass and is
/// none of those to leave alone. Allocates.
[[nodiscard]] ObjectChoice chooseObject(const btDiscreteDynamicsWorld& world,
                                        const PreloadConfig& config,
                                        const std::vector<const void*>& leave_alone);

/// All dynamic bodies of a world.
[[nodiscard]] std::vector<const void*> findMovingBodies(const btDiscreteDynamicsWorld& world);

/// The dynamic bodies of a world in one line, at most eight: "1 box 0.1 0.1 0.1, 0.2 kg; 2 ...".
[[nodiscard]] std::string listObjects(const btDiscreteDynamicsWorld& world);

}  // namespace tandem::preload
