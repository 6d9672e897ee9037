#pragma once

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

namespace tandem::test {

/// A page with tables that a test keeps up to date: with TANDEM_WRITE_DOCS=1 in the environment it
/// writes them.
class Document {
 public:
  explicit Document(std::string path) : path_(std::move(path)) {
    std::ifstream stream(path_, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    text_ = text.str();
  }

  [[nodiscard]] const std::string& text() const { return text_; }

  /// The page with these tables in place of those that have the same first lines, in this order.
  /// Throws std::runtime_error without one.
  template <typename Tables>
  [[nodiscard]] std::string replaceTables(const Tables& tables) const {
    std::string text = text_;
    std::size_t begin = 0;
    for (const std::string& table : tables) {
      const std::string head = table.substr(0, table.find('\n') + 1);
      const std::size_t start = text.find(head, begin);
      if (start == std::string::npos) throw std::runtime_error(path_ + ": has no table " + head);
      const std::size_t end = text.find("\n\n", start);
      text.replace(start, end + 1 - start, table);
      begin = start + table.size();
    }
    if (std::getenv("TANDEM_WRITE_DOCS")) std::ofstream(path_, std::ios::binary) << text;
    return text;
  }

 private:
  std::string path_, text_;
};

}  // namespace tandem::test
