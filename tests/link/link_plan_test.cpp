#include "tandem/coordination/link_plan.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace tandem {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

LinkChange at(double time) {
  LinkChange change;
  change.at = time;
  return change;
}

TEST(LinkPlan, StaysAsItStartsWithoutChanges) {
  LinkPlan plan({{.delay = 0.05}, 0.01, true});
  EXPECT_EQ(plan.nextChange(), kNever);
  EXPECT_EQ(plan.advance(1e6), 0U);
  EXPECT_EQ(plan.settings().impairments.delay, 0.05);
  EXPECT_EQ(plan.settings().corrupt, 0.01);
  EXPECT_TRUE(plan.settings().keep_order);
}

TEST(LinkPlan, ChangesWhatIsNamedWhenItIsDue) {
  LinkChange route = at(1.0);
  route.delay = 0.1;
  route.jitter = 0.01;
  LinkChange weather = at(2.0);
  weather.loss = 0.02;
  weather.duplicate = 0.03;
  weather.reorder = 0.04;
  weather.corrupt = 0.05;
  weather.keep_order = true;
  LinkPlan plan({{.delay = 0.05, .seed = 7}}, {route, weather});

  EXPECT_EQ(plan.nextChange(), 1.0);
  (void)plan.advance(std::nextafter(1.0, 0.0));
  EXPECT_EQ(plan.settings().impairments.delay, 0.05);
  (void)plan.advance(1.0);
  EXPECT_EQ(plan.settings().impairments.delay, 0.1);
  EXPECT_EQ(plan.settings().impairments.jitter, 0.01);
  EXPECT_EQ(plan.settings().impairments.loss, 0.0);
  EXPECT_EQ(plan.nextChange(), 2.0);
  (void)plan.advance(5.0);
  const LinkSettings& end = plan.settings();
  EXPECT_EQ(end.impairments.delay, 0.1);
  EXPECT_EQ(end.impairments.loss, 0.02);
  EXPECT_EQ(end.impairments.duplicate, 0.03);
  EXPECT_EQ(end.impairments.reorder, 0.04);
  EXPECT_EQ(end.impairments.seed, 7U);
  EXPECT_EQ(end.corrupt, 0.05);
  EXPECT_TRUE(end.keep_order);
  EXPECT_EQ(plan.nextChange(), kNever);
}

TEST(LinkPlan, OutageAndCutAreApart) {
  LinkChange cut = at(1.0), outage = at(2.0), back_again = at(3.0), whole = at(4.0);
  cut.cut = LinkCut::kForward;
  outage.outage = true;
  back_again.outage = false;
  whole.cut = LinkCut::kNone;
  LinkPlan plan({}, {cut, outage, back_again, whole});
  const auto isCut = [&](Direction direction) {
    return conditionsOf(plan.settings(), direction).is_cut;
  };
  const bool expected[5][2] = {
      {false, false}, {true, false}, {true, true}, {true, false}, {false, false}};
  for (int second = 0; second < 5; ++second) {
    (void)plan.advance(second);
    EXPECT_EQ(isCut(Direction::kForward), expected[second][0]) << second;
    EXPECT_EQ(isCut(Direction::kBack), expected[second][1]) << second;
  }
}

TEST(LinkPlan, CutsTheWayBackAlone) {
  LinkSettings settings;
  settings.cut = LinkCut::kBack;
  EXPECT_FALSE(conditionsOf(settings, Direction::kForward).is_cut);
  EXPECT_TRUE(conditionsOf(settings, Direction::kBack).is_cut);
}

TEST(LinkPlan, TellsRebindsOnce) {
  LinkChange rebind = at(1.0), other = at(2.0);
  rebind.rebind = true;
  LinkPlan plan({}, {rebind, rebind, other});
  EXPECT_EQ(plan.advance(0.5), 0U);
  EXPECT_EQ(plan.advance(1.5), 2U);
  EXPECT_EQ(plan.advance(9.0), 0U);
}

TEST(LinkPlan, RefusesWhatIsOutOfRangeAtAnyTime) {
  EXPECT_THROW(LinkPlan({{.delay = -1.0}}), std::invalid_argument);
  LinkChange change = at(1.0);
  change.loss = 1.5;
  EXPECT_THROW(LinkPlan({}, {change}), std::invalid_argument);
  change = at(1.0);
  change.corrupt = NAN;
  EXPECT_THROW(LinkPlan({}, {change}), std::invalid_argument);
  EXPECT_THROW(LinkPlan({}, {at(2.0), at(1.0)}), std::invalid_argument);
  EXPECT_THROW(LinkPlan({}, {at(-1.0)}), std::invalid_argument);
  EXPECT_THROW(LinkPlan({}, {at(NAN)}), std::invalid_argument);
  EXPECT_THROW(LinkPlan({}, {at(kNever)}), std::invalid_argument);
}

}  // namespace
}  // namespace tandem
