#pragma once

#include <map>
#include <string>

#include <btBulletDynamicsCommon.h>

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// Names that bodies have in the scenario; those of which it knows nothing are the world.
using BulletNames = std::map<const btRigidBody*, std::string>;

/// A constraint as a joint of a scenario: hinge, slider, point to point, and what locks all six
/// directions. A motor that holds still is friction: its impulse in each `host_step` [s]. Throws
/// UsageError for other kinds. Bullet's getters are not const; the constraint stays as it is.
[[nodiscard]] JointScenario makeJointScenario(btTypedConstraint& constraint,
                                              const BulletNames& names, double host_step);

}  // namespace tandem::demos
