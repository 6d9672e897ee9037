// A program that was built without Cyclone DDS says how to get it.

#include <gtest/gtest.h>

#include "program/process.h"

namespace tandem::test {
namespace {

TEST(WithoutDds, TheCarrierNamesItsPackages) {
  const TempFolder folder;
  EXPECT_EQ(runTandem({"key", "new", folder / "k"}).status, 0);
  expectLine(runTandem({"peer", "--scenario", scenarioPath("experiment1.toml"), "--site", "1",
                        "--key", folder / "k", "--carrier", "dds"}),
             2, "--carrier: this program is built without Cyclone DDS (cyclonedds-dev, ");
}

}  // namespace
}  // namespace tandem::test
