// Average-position coordination: copies that are tied to their mean stay calm for any number of
// users; with the plain sum they do not.

#include <cmath>

#include <gtest/gtest.h>

#include "physics/squeeze.h"

namespace tandem {
namespace {

using test::Squeeze;
using test::SqueezeCase;

/// Rate at which a nudge grows while all press the cube [1/s].
double measureGrowth(const SqueezeCase& wanted) {
  Squeeze squeeze(wanted);
  squeeze.runUntil(3.0);
  squeeze.nudge(Vec3(1e-3, 0, 0));
  squeeze.runUntil(3.3);
  const double early = squeeze.findFastest(0.2);
  squeeze.runUntil(4.3);
  const double late = squeeze.findFastest(0.2);
  EXPECT_EQ(squeeze.status(), 0u);
  return std::log(late / early);
}

class AveragePosition : public ::testing::TestWithParam<SqueezeCase> {};

std::string nameOfCase(const ::testing::TestParamInfo<SqueezeCase>& info) {
  const SqueezeCase& c = info.param;
  return c.scheme + "_" + std::to_string(c.sites) + "_sites_" +
         std::to_string(std::lround(1e3 * c.delay)) + "ms" + (c.is_guided ? "" : "_free");
}

std::vector<SqueezeCase> makeCases() {
  std::vector<SqueezeCase> cases;
  for (const char* scheme : {"virtual_coupling", "remote_dynamic_proxy"}) {
    for (const double delay : {0.02, 0.05})
      for (const int sites : {2, 3, 4, 8, 16})
        cases.push_back({scheme, CoordinationMode::kAverage, sites, delay});
    for (const int sites : {3, 8})
      cases.push_back({scheme, CoordinationMode::kAverage, sites, 0.05, false});
  }
  return cases;
}

// The slowest of these dies out at 0.8 1/s.
TEST_P(AveragePosition, CalmsDown) { EXPECT_LT(measureGrowth(GetParam()), -0.6); }

INSTANTIATE_TEST_SUITE_P(Users, AveragePosition, ::testing::ValuesIn(makeCases()), nameOfCase);

// Rates that a stability analysis of the lifted multirate system gives for held hands.
TEST(SumOfAllCopies, GrowsAsTheAnalysisSays) {
  const auto measure = [](int sites) {
    return measureGrowth({"virtual_coupling", CoordinationMode::kSum, sites, 0.02});
  };
  EXPECT_NEAR(measure(2), -6.5, 0.1);
  EXPECT_NEAR(measure(3), -1.2, 0.1);
  EXPECT_NEAR(measure(4), 0.7, 0.1);
}

// Whole stand-ins would weigh more than the copy that they push, and grow by 3 1/s.
TEST(AveragePositionOfThree, HasStandInsOfHalfAUser) {
  Squeeze squeeze({"remote_dynamic_proxy", CoordinationMode::kAverage, 3, 0.02});
  EXPECT_NEAR(1.0 / static_cast<double>(squeeze.site(0).proxyBody(0)->getInvMass()), 0.05, 1e-9);
  EXPECT_NEAR(1.0 / static_cast<double>(squeeze.site(0).proxyBody(1)->getInvMass()), 0.05, 1e-9);
}

}  // namespace
}  // namespace tandem
