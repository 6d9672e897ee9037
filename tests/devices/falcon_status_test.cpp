#include "tandem/falcon/falcon_status.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "falcon/src/novint/falcon_boot.h"

namespace tandem {
namespace {

TEST(FalconStatus, EveryStateAndFaultHasWordsOfItsOwn) {
  std::set<std::string> names, texts;
  for (int i = 0; i <= static_cast<int>(FalconState::kFault); ++i)
    names.insert(nameOf(static_cast<FalconState>(i)));
  EXPECT_EQ(names.size(), 6U);
  EXPECT_EQ(names.count("unknown"), 0U);
  for (int i = 0; i <= static_cast<int>(FalconFault::kOutOfReach); ++i)
    texts.insert(textOf(static_cast<FalconFault>(i)));
  EXPECT_EQ(texts.size(), 13U);
  EXPECT_EQ(texts.count("unknown fault"), 0U);
}

TEST(FalconStatus, EveryWayNotToBootIsAFault) {
  std::set<FalconFault> faults;
  for (int i = 0; i <= static_cast<int>(BootFault::kNotRunning); ++i)
    faults.insert(faultOf(static_cast<BootFault>(i)));
  EXPECT_EQ(faults.size(), 6U);
}

TEST(FalconStatus, RoundTripsAreCountedInBins) {
  FalconRoundTrips trips;
  EXPECT_EQ(trips.mean(), 0.0);
  for (const double time : {0.0004, 0.0012, 0.5}) trips.add(time);
  EXPECT_EQ(trips.count, 3U);
  EXPECT_EQ(trips.least, 0.0004);
  EXPECT_EQ(trips.most, 0.5);
  EXPECT_NEAR(trips.mean(), 0.5016 / 3.0, 1e-12);
  EXPECT_EQ(trips.bins[0], 1U);
  EXPECT_EQ(trips.bins[2], 1U);
  EXPECT_EQ(trips.bins.back(), 1U);
}

}  // namespace
}  // namespace tandem
