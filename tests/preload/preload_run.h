#pragma once

#include <string>
#include <vector>

#include "program/process.h"

namespace tandem::test {

/// Runs a program unchanged.
[[nodiscard]] inline Outcome runBare(const std::string& program,
                                     const std::vector<std::string>& arguments = {}) {
  return runProgram(program, arguments);
}

/// Runs a program with the library of this build, or another one, in LD_PRELOAD. Sets
/// TANDEM_PRELOAD if there is a config.
[[nodiscard]] inline Outcome runPreloaded(const std::string& program,
                                          const std::vector<std::string>& arguments,
                                          const std::string& config,
                                          const std::string& library = TANDEM_PRELOAD_LIBRARY) {
  std::vector<std::string> words{"LD_PRELOAD=" + library};
  if (!config.empty()) words.push_back("TANDEM_PRELOAD=" + config);
  words.push_back(program);
  words.insert(words.end(), arguments.begin(), arguments.end());
  return runProgram("/usr/bin/env", words);
}

}  // namespace tandem::test
