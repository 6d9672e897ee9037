#pragma once

#include <string>

namespace tandem::demos::bench {

/// Collects the names of settings that differ from a twin's.
class Differences {
 public:
  void expect(bool is_equal, const char* name) {
    if (!is_equal) text_ += std::string(" ") + name;
  }
  /// Each after a space; empty if there is none.
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace tandem::demos::bench
