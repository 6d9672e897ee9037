#pragma once

#include <memory>

#include <btBulletDynamicsCommon.h>

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// A body of a joint, and its pose in W at the scenario's start.
struct JointEnd {
  btRigidBody* body = nullptr;
  btTransform start;
};

/// Makes Bullet's constraint for a joint at `frame` in W, whose z is its axis. `second` is null for
/// a joint with the world. Frames are those of the start, wherever the bodies are by now. Bullet
/// takes a hinge's friction per step of `host_step` [s].
[[nodiscard]] std::unique_ptr<btTypedConstraint> makeJoint(const JointScenario& joint,
                                                           const btTransform& frame,
                                                           const JointEnd& first,
                                                           const JointEnd* second,
                                                           double host_step);

}  // namespace tandem::demos
