#pragma once

#include "device/device_task.h"
#include "device/exchange.h"

namespace tandem::demos {

struct GetReadySettings {
  double patience = 120.0;  ///< [s]
  bool to_middle = true;    ///< and the grip is held in the middle of its workspace
  bool is_quiet = false;
};

/// As a command asks for it.
[[nodiscard]] inline GetReadySettings makeGetReadySettings(const DeviceTask& task, bool to_middle) {
  return {task.patience, to_middle, task.quiet || task.json};
}

/// Until the device gives true positions: prints the lines of instruction when there is something
/// to do, and what it does meanwhile. Throws tandem::Error with the remedy if it cannot boot or is
/// not ready within `patience`. False if `pause` says to end.
bool getReady(LiveDevice& device, const GetReadySettings& settings, const Pause& pause);

}  // namespace tandem::demos
