// A program that was built without Cyclone DDS says how to get it.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

TEST(WithoutDds, OptionsNameThePackages) {
  const TempFolder folder;
  EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0);
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> line = {"peer",      "--scenario", scenarioPath("experiment1.toml"),
                                     "--site",    "1",          "--key",
                                     folder / "k"};
    line.insert(line.end(), more.begin(), more.end());
    return runTandem(line);
  };
  expectLine(with({"--carrier", "dds"}), 2, "--carrier: this program is built without Cyclone DDS");
  expectLine(with({"--bind", ":7001", "--peer", "localhost:7002", "--publish", "dds"}), 2,
             "cyclonedds-dev, cyclonedds-tools");
}

}  // namespace
}  // namespace tandem::test
