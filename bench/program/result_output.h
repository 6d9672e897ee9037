#pragma once

#include <optional>
#include <string>

#include "demos/program/files/output_folder.h"

namespace tandem::demos::bench {

/// Output of a benchmark's result: to stdout, and into a folder if one is given.
class ResultOutput {
 public:
  bool json = false;                  ///< print JSON instead of a table
  std::optional<std::string> folder;  ///< folder for the JSON and the figures

  /// Opens the folder before the measurement, and checks that figures can be drawn. Throws
  /// UsageError or Error.
  void open();
  /// Writes `name`.json with its figures, and prints. Throws Error.
  void write(const std::string& name, const std::string& json_text, const std::string& table) const;

 private:
  std::optional<OutputFolder> files_;
};

}  // namespace tandem::demos::bench
