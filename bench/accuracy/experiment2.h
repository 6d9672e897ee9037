#pragma once

#include <functional>

#include "bench/accuracy/accuracy.h"

namespace tandem::demos::bench {

/// Experiment II of Li & Constantinescu (2009): both users, their devices and the network between.
/// Compares VirtualRun with the model's own equations, integrated independently of the library.
/// Errors are taken at every haptic tick: `tool` of devices and proxies, `force` of the devices.
/// Run times are those of both sites together.
[[nodiscard]] SceneAccuracy measureExperiment2(const std::vector<int>& host_rates, bool quick);

/// Name of Experiment II among the scenes.
inline constexpr std::string_view kExperiment2 = "experiment2";

}  // namespace tandem::demos::bench
