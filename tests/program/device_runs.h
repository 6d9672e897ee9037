#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {

using Words = std::vector<std::string>;

/// Runs the command with an emulated Falcon.
inline Outcome runEmulated(const std::string& command, const Words& more = {}) {
  Words words = {"device"};
  if (!command.empty()) words.push_back(command);
  words.insert(words.end(), {"--device", "emulated"});
  words.insert(words.end(), more.begin(), more.end());
  return runTandem(words);
}

inline void expectRefused(const Outcome& outcome, int status, const Words& words) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(outcome.err.find(word), std::string::npos) << '"' << word << "\" in: " << outcome.err;
}

}  // namespace tandem::test
