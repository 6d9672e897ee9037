// docs/scenarios.md says what the program's table of keys says. To bring it up to date, run this
// test with TANDEM_WRITE_DOCS=1 in the environment.

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "demos/program/scenario/scenario.h"

namespace tandem::demos {
namespace {

const std::string kDocument = TANDEM_SCENARIOS "/../../docs/scenarios.md";

std::string readDocument() {
  std::ifstream stream(kDocument, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// Puts a table in place of the one at or after `begin` that has the same first line. Gives back
/// where it ends.
std::size_t replaceTable(std::string& text, std::size_t begin, const std::string& table) {
  const std::string head = table.substr(0, table.find('\n') + 1);
  const std::size_t start = text.find(head, begin);
  if (start == std::string::npos) throw std::runtime_error(kDocument + ": has no table " + head);
  const std::size_t end = text.find("\n\n", start);
  text.replace(start, end + 1 - start, table);
  return start + table.size();
}

TEST(ScenarioKeys, StandInTheDocument) {
  const std::string document = readDocument();
  std::string expected = document;
  std::size_t end = 0;
  for (const std::string& table : describeKeys()) end = replaceTable(expected, end, table);
  if (std::getenv("TANDEM_WRITE_DOCS")) std::ofstream(kDocument, std::ios::binary) << expected;
  EXPECT_EQ(document, expected) << "run this test with TANDEM_WRITE_DOCS=1";
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
