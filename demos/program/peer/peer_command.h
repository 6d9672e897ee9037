#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/device_options.h"

namespace tandem::demos {

/// `tandem peer`: one site of a scenario, live over UDP.
struct PeerCommand {
  std::string scenario;
  std::vector<std::string> overrides;
  int site = 0;
  std::string bind;
  std::string peer;
  std::string key;
  std::optional<std::string> folder;
  double patience = 30.0;  ///< time to wait for the other site [s]
  std::string playout = "on";
  std::string profile = "float32";
  bool quiet = false;
  DeviceOptions device;  ///< without --device: simulated, as the scenario says
};

/// Runs it to its end. Throws UsageError or std::invalid_argument for what cannot be (status 2),
/// tandem::Error for what went wrong.
void runPeerCommand(const PeerCommand& command);

}  // namespace tandem::demos
