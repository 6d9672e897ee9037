#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tandem::demos::bench {

/// Options of `tandem bench accuracy`.
struct AccuracyCommand {
  bool json = false;
  bool quick = false;
  std::vector<std::string> scenes;    ///< names; empty: all
  std::optional<std::string> folder;  ///< folder for accuracy.json, accuracy.svg and accuracy.png
};

/// Measures, prints table or JSON, writes files. Throws UsageError or tandem::Error, one line.
void runAccuracyCommand(const AccuracyCommand& command);

}  // namespace tandem::demos::bench
