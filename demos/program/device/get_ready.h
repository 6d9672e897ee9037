#pragma once

#include "device/device_task.h"
#include "device/exchange.h"

namespace tandem::demos {

struct GetReadySettings {
  double patience = 120.0;  ///< [s]
  bool to_middle = true;    ///< also waits for the grip in the workspace's middle
  bool is_quiet = false;
};

/// Settings from a command's options.
[[nodiscard]] inline GetReadySettings makeGetReadySettings(const DeviceTask& task, bool to_middle) {
  return {task.patience, to_middle, task.quiet || task.json};
}

/// Waits until the device gives valid positions. Prints instructions if the user must act, and
/// shows progress. Throws tandem::Error with the remedy if it cannot boot or is not ready within
/// `patience`. Returns false if `pause` returns true.
bool getReady(LiveDevice& device, const GetReadySettings& settings, const Pause& pause);

}  // namespace tandem::demos
