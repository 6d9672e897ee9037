#pragma once

#include <functional>
#include <vector>

#include "device/live_device.h"

namespace tandem::demos {

/// Waits for `seconds`. Returns true, then at once, if the user asks to end.
using Pause = std::function<bool(double seconds)>;

/// Computes the force to write from the time since the beginning [s] and the reading [N].
using MakeForce = std::function<Vec3(double t, const DeviceSample&)>;

/// Exchanges with the device a thousand times a second for `duration` [s], from this thread. A late
/// period runs at once, and missed periods are skipped. `lateness` gets the delay of each period's
/// beginning [s]. Returns false if asked to end.
bool exchange(LiveDevice& device, double duration, const Pause& pause, const MakeForce& make_force,
              std::vector<double>* lateness = nullptr);

}  // namespace tandem::demos
