// A live session is told when its gains do not fit the delay that is measured.
#include "demos/program/analyse/growth_watch.h"

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "program/process.h"
#include "program/tandem_program.h"

namespace tandem::demos {
namespace {

Scenario load(const std::vector<std::string>& overrides) {
  return loadScenario(test::scenarioPath("experiment1.toml"), overrides);
}

/// Looks until there is a line, or an analysis has found none.
std::optional<std::string> lookFor(GrowthWatch& watch, double delay) {
  auto line = watch.look(delay);
  while (!line && watch.isAnalysing()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    line = watch.look(delay);
  }
  return line;
}

TEST(GrowthWatch, TellsWhenADelayIsTooLongAndWhenItFitsAgain) {
  GrowthWatch watch(load({"experiment.scheme=virtual_coupling"}));
  EXPECT_FALSE(lookFor(watch, 0.05));
  const auto too_long = lookFor(watch, 0.15);
  ASSERT_TRUE(too_long);
  EXPECT_EQ(too_long->rfind("at the measured delay of 150 ms the gains do not fit", 0), 0u);
  EXPECT_NE(too_long->find("coordination.stiffness = "), std::string::npos) << *too_long;
  EXPECT_FALSE(lookFor(watch, 0.152));  // no news
  const auto again = lookFor(watch, 0.04);
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, "at the measured delay of 40 ms the gains fit again");
}

TEST(GrowthWatch, SaysNothingOfWhatItCannotAnalyse) {
  GrowthWatch watch(load({"contact.model=native_rigid"}));
  EXPECT_FALSE(watch.look(0.3));
  GrowthWatch other(load({}));
  EXPECT_FALSE(other.look(-1.0));  // no peer is there
}

}  // namespace
}  // namespace tandem::demos
