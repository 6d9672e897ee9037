// A scenario that was written into a run's summary is read back as it was.

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tandem/plugin/toml_text.h"

#include "demos/program/scenario/scenario.h"
#include "demos/program/terminal/usage_error.h"
#include "support/checkout.h"

namespace tandem::demos {
namespace {

std::string messageOf(const nlohmann::json& described) {
  try {
    (void)readScenario(described, "summary.json");
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(DescribedScenario, IsReadBackAsItWas) {
  int count = 0;
  for (const char* folder : {"demos/scenarios", "demos/worlds"}) {
    for (const auto& entry : std::filesystem::directory_iterator(test::inCheckout(folder))) {
      if (entry.path().extension() != ".toml") continue;
      const nlohmann::json described = describeScenario(loadScenario(entry.path(), {}));
      EXPECT_EQ(describeScenario(readScenario(described, "summary.json")), described)
          << entry.path();
      ++count;
    }
  }
  EXPECT_GE(count, 6);
}

TEST(DescribedScenario, MayHaveAllDefaults) {
  const nlohmann::json described = describeScenario({});
  EXPECT_EQ(describeScenario(readScenario(described, "summary.json")), described);
}

TEST(DescribedScenario, IsReadBackThroughText) {
  const nlohmann::json described = describeScenario(
      parseScenario("title = 'a \"b\" \\'\nobject.mass = 0.1234567890123456\nnetwork.seed = 7", "x",
                    {"site1.hand_waypoints=[[0,0,0,0],[1,0.1,0,0]]"}));
  const nlohmann::json again = nlohmann::json::parse(described.dump());
  EXPECT_EQ(describeScenario(readScenario(again, "summary.json")), described);
}

TEST(DescribedScenario, NamesWhatIsBroken) {
  EXPECT_EQ(messageOf({{"object", {{"mass", -1}}}}),
            "summary.json: object.mass = -1: must be a finite number above 0");
  EXPECT_NE(
      messageOf({{"object", {{"weight", 1}}}}).find("object.weight = 1: there is no such key"),
      std::string::npos);
  const std::string foreign =
      "summary.json: the scenario is none of Tandem's; record the run again";
  EXPECT_EQ(messageOf(nlohmann::json::array({1})), foreign);
  EXPECT_EQ(messageOf({{"object", {{"mass", nullptr}}}}), foreign);
  nlohmann::json deep = 1;
  for (int level = 0; level < kDeepestToml + 5; ++level) deep = nlohmann::json::array({deep});
  EXPECT_EQ(messageOf({{"world", {{"boxes", deep}}}}), foreign);
}

}  // namespace
}  // namespace tandem::demos
