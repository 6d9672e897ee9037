#pragma once

#include <optional>
#include <string>

namespace tandem::demos::bench {

/// Options of `tandem bench speed`.
struct SpeedCommand {
  bool json = false;
  bool quick = false;
  std::optional<std::string> folder;  ///< folder for speed.json, speed.svg and speed.png
};

/// Measures, prints table or JSON, writes files. Throws UsageError or tandem::Error, one line.
void runSpeedCommand(const SpeedCommand& command);

}  // namespace tandem::demos::bench
