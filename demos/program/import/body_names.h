#pragma once

#include <set>
#include <string>

namespace tandem::demos {

/// Gives names that a scenario takes, each once, to bodies of a file.
class BodyNames {
 public:
  /// A name as near to `wanted` as may be: other letters become '_', and a taken name gets a
  /// number.
  [[nodiscard]] std::string make(const std::string& wanted);

 private:
  std::set<std::string> taken_ = {"device", "proxy", "floor", "hand"};  // Tandem's own
};

}  // namespace tandem::demos
