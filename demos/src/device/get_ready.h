#pragma once

#include "device/exchange.h"

namespace tandem::demos {

struct GetReadySettings {
  double patience = 120.0;  ///< [s]
  bool to_middle = true;    ///< and the grip is held in the middle of its workspace
  bool is_quiet = false;
};

/// Until the device gives true positions: prints the lines of instruction when there is something
/// to do, and what it does meanwhile. Throws tandem::Error with the remedy if it cannot boot or is
/// not ready within `patience`. False if `pause` says to end.
bool getReady(LiveDevice& device, const GetReadySettings& settings, const Pause& pause);

}  // namespace tandem::demos
