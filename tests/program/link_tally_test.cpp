// Measurements of `tandem link` about itself.

#include "demos/program/link/link_tally.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace tandem::demos {
namespace {

constexpr double kClassWidth = 5.1e-4;  // class width of DurationHistogram, relative

TEST(DurationHistogram, GivesPercentilesWithinItsClasses) {
  DurationHistogram histogram;
  EXPECT_TRUE(std::isnan(histogram.percentile(0.5)));
  for (int i = 1; i <= 1000; ++i) histogram.add(1e-4 * i);
  EXPECT_NEAR(histogram.percentile(0.0), 1e-4, 1e-4 * kClassWidth);
  EXPECT_NEAR(histogram.percentile(0.5), 0.05, 0.05 * kClassWidth);
  EXPECT_NEAR(histogram.percentile(0.99), 0.099, 0.099 * kClassWidth);
  EXPECT_NEAR(histogram.percentile(1.0), 0.1, 0.1 * kClassWidth);
}

TEST(DurationHistogram, CountsWhatIsOutsideAtItsEnds) {
  DurationHistogram histogram;
  histogram.add(-1.0);
  histogram.add(0.0);
  histogram.add(1e9);
  EXPECT_NEAR(histogram.percentile(0.5), 1e-7, 1e-10);
  EXPECT_GT(histogram.percentile(1.0), 90.0);
}

Delivery makeDelivery(double sent, double due, double delay, double jitter) {
  Delivery delivery;
  delivery.sent = sent;
  delivery.due = due;
  delivery.delay = delay;
  delivery.jitter = jitter;
  return delivery;
}

TEST(LinkTally, HasNothingToTellWithoutDatagrams) {
  const LinkTally tally;
  EXPECT_TRUE(std::isnan(tally.asked().loss));
  EXPECT_TRUE(std::isnan(tally.asked().delay));
  EXPECT_TRUE(std::isnan(tally.achieved({}).loss));
  EXPECT_TRUE(std::isnan(tally.achieved({}).jitter));
}

// Half of them are sent at 10 %, half at 30 %: 20 % was asked. Datagrams cut off do not count.
TEST(LinkTally, AveragesWhatWasAskedWhileItChanged) {
  LinkTally tally;
  DatagramChannelCounts counts;
  for (int i = 0; i < 100; ++i) {
    const double loss = i < 50 ? 0.1 : 0.3;
    const bool is_lost = i % 10 == 0;
    tally.noteSent({{.loss = loss, .duplicate = 0.5}},
                   is_lost ? Entrance::kLost : Entrance::kOnItsWay);
    counts.lost += is_lost ? 1 : 0;
  }
  for (int i = 0; i < 10; ++i) tally.noteSent({{.loss = 1.0}, 0.0, false, true}, Entrance::kCutOff);
  counts.sent = 110;
  counts.cut_off = 10;
  counts.duplicated = 9;
  counts.corrupted = 33;
  EXPECT_NEAR(tally.asked().loss, 0.2, 1e-12);
  EXPECT_NEAR(tally.asked().duplicate, 0.5, 1e-12);
  const LinkFigures achieved = tally.achieved(counts);
  EXPECT_NEAR(achieved.loss, 0.1, 1e-12);
  EXPECT_NEAR(achieved.duplicate, 0.1, 1e-12);        // 9 of the 90 that were not lost
  EXPECT_NEAR(achieved.corrupt, 33.0 / 99.0, 1e-12);  // 33 of the 99 copies
}

TEST(LinkTally, TellsDelayJitterAndWhatTheLinkAddsOfItself) {
  LinkTally tally;
  constexpr double kAdded = 1e-4;  // [s]
  constexpr int kCount = 1001;
  for (int i = 0; i < kCount; ++i) {
    const double even = 2.0 * i / (kCount - 1) - 1.0;  // -1 to 1
    const double due = i + 0.05 + 0.01 * even;
    tally.noteDelivered(makeDelivery(i, due, 0.05, 0.01), due + kAdded);
  }
  Delivery at_once = makeDelivery(5.0, 5.0, 0.05, 0.01);
  at_once.is_reordered = true;
  tally.noteDelivered(at_once, 5.0 + kAdded);

  const LinkFigures achieved = tally.achieved({});
  EXPECT_NEAR(tally.asked().delay, 0.05, 1e-12);
  EXPECT_NEAR(tally.asked().jitter, 0.01, 1e-12);
  EXPECT_NEAR(achieved.delay, 0.05 + kAdded, 1e-9);
  EXPECT_NEAR(achieved.jitter, 0.01,
              2.0 * 0.01 / kCount);  // a uniform spread, apart from its steps
  EXPECT_NEAR(tally.latencies().percentile(0.5), kAdded, kAdded * kClassWidth);
  EXPECT_NEAR(tally.delays().percentile(0.5), 0.05 + kAdded, 0.05 * 2.0 * kClassWidth);
}

// The part of the spread below 0 counts as 0, both asked and achieved.
TEST(LinkTally, KnowsThatNoDelayIsBelowZero) {
  LinkTally tally;
  constexpr int kCount = 10001;
  for (int i = 0; i < kCount; ++i) {
    const double even = 2.0 * i / (kCount - 1) - 1.0;  // -1 to 1
    const double due = 1.0 + std::max(0.0, 0.01 + 0.03 * even);
    tally.noteDelivered(makeDelivery(1.0, due, 0.01, 0.03), due);
  }
  const LinkFigures asked = tally.asked(), achieved = tally.achieved({});
  EXPECT_NEAR(asked.delay, 0.04 * 0.04 / (4.0 * 0.03), 1e-12);
  EXPECT_NEAR(achieved.delay, asked.delay, 0.03 / kCount);
  EXPECT_NEAR(achieved.jitter, asked.jitter, 0.03 / kCount * 2.0);
}

}  // namespace
}  // namespace tandem::demos
