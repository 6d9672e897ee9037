#pragma once

#include "reference/rigid_scene.h"

namespace tandem::reference {

/// Advances the scene by `duration` in equal Runge-Kutta 4 steps of at most `max_step` [s].
///
/// Forces, torques and targets are held. A box turns by Euler's equations including the gyroscopic
/// term: its orientation and its angular momentum in W are integrated. Throws std::invalid_argument
/// when `max_step` or the mass or inertia of a body is not positive.
void advanceScene(RigidScene& scene, double duration, double max_step);

}  // namespace tandem::reference
