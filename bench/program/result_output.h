#pragma once

#include <optional>
#include <string>

namespace tandem::demos::bench {

/// Output of a benchmark's result: to stdout, and into a folder if one is given.
struct ResultOutput {
  bool json = false;                  ///< print JSON instead of a table
  std::optional<std::string> folder;  ///< folder for the JSON and the figures

  /// Checks before the measurement that the folder and the figures can be made. Throws UsageError
  /// or Error.
  void check() const;
  /// Writes `name`.json with its figures, and prints. Throws Error.
  void write(const std::string& name, const std::string& json_text, const std::string& table) const;
};

}  // namespace tandem::demos::bench
