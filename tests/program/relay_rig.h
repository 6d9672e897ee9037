#pragma once

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program/background.h"
#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {

/// A relay with its key, and the key of a pair.
struct RelayRig {
  explicit RelayRig(const std::vector<std::string>& more = {}) {
    for (const char* name : {"relay", "pair"})
      EXPECT_EQ(runTandem({"key", "new", folder / name}).status, 0);
    std::vector<std::string> line = {"relay", "--bind", ownLoopback() + ":0", "--key",
                                     folder / "relay"};
    line.insert(line.end(), more.begin(), more.end());
    relay = std::make_unique<Background>(tandemProgram(), line);
    const std::string first = relay->readLine();
    address = first.substr(first.rfind(' ') + 1);
  }
  [[nodiscard]] std::vector<std::string> site(int number, const std::vector<std::string>& more) {
    std::vector<std::string> line = {"peer",
                                     "--scenario",
                                     scenarioPath("experiment1.toml"),
                                     "--site",
                                     std::to_string(number),
                                     "--bind",
                                     ownLoopback() + ":0",
                                     "--key",
                                     folder / "pair",
                                     "--relay",
                                     address};
    line.insert(line.end(), more.begin(), more.end());
    return line;
  }

  TempFolder folder;
  std::unique_ptr<Background> relay;
  std::string address;
};

}  // namespace tandem::test
