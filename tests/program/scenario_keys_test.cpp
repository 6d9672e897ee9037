// docs/scenarios.md says what the program's table of keys says. To bring it up to date, run this
// test with TANDEM_WRITE_DOCS=1 in the environment.

#include <string>

#include <gtest/gtest.h>

#include "demos/program/scenario/scenario.h"
#include "support/checkout.h"
#include "support/document.h"

namespace tandem::demos {
namespace {

TEST(ScenarioKeys, StandInTheDocument) {
  const test::Document document(test::inCheckout("docs/scenarios.md"));
  EXPECT_EQ(document.text(), document.replaceTables(describeKeys()))
      << "run this test with TANDEM_WRITE_DOCS=1";
}

TEST(ScenarioKeys, ThatAreASitesOwnMayDiffer) {
  for (const char* own : {"title", "site", "site2.hand_force", "device.mass", "guard.max_slew",
                          "network.loss", "rates.inner", "bridge.injection"})
    EXPECT_TRUE(isOwnKey(own)) << own;
  for (const char* shared : {"contact.stiffness", "proxy.radius", "network.rate", "rates.haptic",
                             "network.link_loss", "object.mass", "experiment.scheme"})
    EXPECT_FALSE(isOwnKey(shared)) << shared;
}

}  // namespace
}  // namespace tandem::demos
