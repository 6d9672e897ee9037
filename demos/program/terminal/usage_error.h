#pragma once

#include <stdexcept>
#include <string>

namespace tandem::demos {

/// Bad use of the program or a bad input file. The message is one line that names the file and the
/// key or column. The program prints it and ends with status 2.
class UsageError : public std::runtime_error {
 public:
  explicit UsageError(const std::string& message) : std::runtime_error(makeOneLine(message)) {}

 private:
  // Messages quote user input, in which a line break or escape sequence would split or hide them.
  static std::string makeOneLine(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
    return text;
  }
};

}  // namespace tandem::demos
