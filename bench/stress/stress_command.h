#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace tandem::demos::bench {

/// Options of `tandem bench stress`.
struct StressCommand {
  bool json = false;
  bool quick = false;
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> cases;  ///< empty: 20000, or 1000 with `quick`
  std::optional<std::uint64_t> one;    ///< only this case
  std::optional<std::string> folder;   ///< folder for stress.json, stability.svg and stability.png
};

/// Runs, prints table or JSON, writes files. Returns false if a case failed. Throws UsageError or
/// tandem::Error, one line.
[[nodiscard]] bool runStressCommand(const StressCommand& command);

}  // namespace tandem::demos::bench
