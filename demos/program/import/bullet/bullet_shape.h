#pragma once

#include <btBulletDynamicsCommon.h>

#include "scenario/body_scenario.h"

namespace tandem::demos {

/// Gives a body the form of Bullet's shape, as parts where it has an own place in the body. Throws
/// UsageError for a shape that a scenario does not have.
void takeShape(const btCollisionShape& shape, BodyScenario& body);

}  // namespace tandem::demos
