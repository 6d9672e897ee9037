#pragma once

#include <functional>
#include <vector>

#include "device/live_device.h"

namespace tandem::demos {

/// Waits so long [s]; true if somebody asks to end, then at once.
using Pause = std::function<bool(double seconds)>;

/// The force to write, by the time since the beginning [s] and the reading [N].
using MakeForce = std::function<Vec3(double t, const DeviceSample&)>;

/// Talks to the device a thousand times a second for `duration` [s], from this thread. What is late
/// is done at once; periods that have passed are left out. `lateness` gets the beginnings of
/// periods after their moments [s]. False if asked to end.
bool exchange(LiveDevice& device, double duration, const Pause& pause, const MakeForce& make_force,
              std::vector<double>* lateness = nullptr);

}  // namespace tandem::demos
