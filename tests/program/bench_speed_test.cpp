// Use of `tandem bench speed`. Run times are measured, never asserted.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::test {
namespace {

using Json = nlohmann::json;

TEST(BenchSpeed, JsonIsExactlyTheFileAndHoldsEveryWay) {
  const TempFolder folder;
  const Outcome outcome =
      runTandem({"bench", "speed", "--quick", "--json", "--out", folder / "speed"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");  // progress is for terminals
  EXPECT_EQ(outcome.out, readFile(folder / "speed/speed.json"));
  EXPECT_EQ(listFolder(folder / "speed"),
            (std::vector<std::string>{"speed.json", "speed.png", "speed.svg"}));

  const Json bench = Json::parse(outcome.out);
  EXPECT_EQ(bench["format"], "tandem-bench-speed");
  for (const Json& c : bench["cases"]) {
    const bool is_idle_crowd = c["touch"] == "nothing" && c["objects"] == 1;
    const bool is_of_users = c["name"].get<std::string>().find("users") != std::string::npos;
    EXPECT_GE(c["results"].size(), is_idle_crowd || is_of_users ? 2u : 4u) << c["name"];
    EXPECT_GE(c["users"].get<int>(), 2) << c["name"];
    for (const Json& result : c["results"]) {
      EXPECT_GT(result["us_per_second"].get<double>(), 0.0);
      EXPECT_EQ(result.contains("us_per_tick"), result["way"] == "Bullet 60 Hz + island");
    }
  }
  EXPECT_EQ(bench["island_ticks"].size(), 2u);
  for (const Json& check : bench["checks"]) {
    const double value = check["value"], limit = check["limit"];
    EXPECT_EQ(check["passes"], check["bound"] == "at_least" ? value >= limit : value <= limit);
  }
}

TEST(BenchSpeed, TableSaysWhatIsWhat) {
  const Outcome outcome = runTandem({"bench", "speed", "--quick"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* word : {"Bullet 240 Hz", "whole world 1 kHz", "row of 3 pushed",
                           "256 shared, none touched", "8 users", "island tick, lone couplers"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " in:\n" << outcome.out;
}

}  // namespace
}  // namespace tandem::test
