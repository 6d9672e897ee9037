#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

#include "program/process.h"

namespace tandem::test {

/// A program that runs beside the test, killed at the end if still running. Both its outputs are
/// merged.
class Background {
 public:
  Background(const std::string& program, const std::vector<std::string>& arguments);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// The next line of its output, without the line end. Throws if none comes in a minute.
  [[nodiscard]] std::string readLine();

  /// Sends a signal (0: none) and waits for the end. Outcome::out is the unread output;
  /// Outcome::err stays empty.
  [[nodiscard]] Outcome finish(int signal);

 private:
  [[nodiscard]] bool readMore();

  pid_t child_ = -1;
  int output_ = -1;
  std::string unread_;
};

}  // namespace tandem::test
