// Debian's unmodified Bullet plugin of Ignition Physics. A hand from a config pushes a box of its
// world, over a floor and free in a slot.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include <gtest/gtest.h>

#include "preload/preload_run.h"

namespace tandem::test {
namespace {

constexpr double kBoxMass = 0.2, kHandMass = 0.1;  // [kg]

struct Row {
  double t, x, y, z;
};

std::vector<Row> readRows(const std::string& text) {
  std::vector<Row> rows;
  std::istringstream stream(text);
  for (Row row{}; stream >> row.t >> row.x >> row.y >> row.z;) rows.push_back(row);
  return rows;
}

std::vector<std::string> inScene(const char* scene) { return {TANDEM_IGNITION_PLUGIN, scene}; }

/// Places of the box at the ends of the rows, in steps of 1 us. The hand's mass pushes it along x
/// with a force F through K and B; Coulomb friction acts against it. Like a device, the hand holds
/// the force of a tick's start for 1 ms. In the contact it meanwhile moves on at its velocity.
std::vector<double> computePushed(double force, double friction) {
  constexpr double kStiffness = 4000, kDamping = 20;  // [N/m, N s/m]
  constexpr int kTick = 1000;                         // steps in a tick
  constexpr double h = 1e-6;                          // [s]
  double hand_x = 0, hand_v = 0, box_x = 0, box_v = 0, held_f = 0, tick_x = 0, tick_v = 0;
  const auto press = [&](double x, double v, double box_at) {
    const double depth = x - box_at;
    return depth > 0 ? std::max(0.0, kStiffness * depth + kDamping * (v - box_v)) : 0.0;
  };
  std::vector<double> positions;
  for (int i = 0; i < 500 * kTick; ++i) {
    if (i % kTick == 0) {
      tick_x = hand_x;
      tick_v = hand_v;
      held_f = press(hand_x, hand_v, box_x);
    }
    const double into_tick = h * (i % kTick + 0.5);
    // Force in the middle of the step, where the box has gained half of this force's change in
    // speed.
    const double f = press(tick_x + tick_v * into_tick, tick_v, box_x + 0.5 * h * box_v) /
                     (1.0 + 0.5 * h * kDamping / kBoxMass);
    const double hand_a = (force - held_f) / kHandMass;
    const double box_a = box_v > 0 || f > friction ? (f - friction) / kBoxMass : 0.0;
    hand_x += h * hand_v + 0.5 * h * h * hand_a;
    hand_v += h * hand_a;
    box_x += h * box_v + 0.5 * h * h * box_a;
    box_v = std::max(0.0, box_v + h * box_a);
    if ((i + 1) % (50 * kTick) == 0) positions.push_back(box_x);
  }
  return positions;
}

/// Largest distance along x between the rows and the model.
double compare(const std::vector<Row>& rows, const std::vector<double>& model) {
  EXPECT_EQ(rows.size(), model.size());
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(rows.size(), model.size()); ++i)
    largest = std::max(largest, std::abs(rows[i].x - model[i]));
  std::printf("largest distance from the model %.3g m of %.3g m\n", largest, model.back());
  return largest;
}

TEST(IgnitionHost, IsTheSameWithoutAConfig) {
  for (const char* scene : {"floor", "free", "visitors"}) {
    const Outcome bare = runBare(TANDEM_IGNITION_HOST, inScene(scene));
    ASSERT_EQ(bare.status, 0) << bare.err;
    EXPECT_EQ(readRows(bare.out).size(), std::string(scene) == "visitors" ? 9u : 10u);
    const Outcome outcome = runPreloaded(TANDEM_IGNITION_HOST, inScene(scene), "");
    EXPECT_EQ(outcome.out, bare.out);
    EXPECT_NE(outcome.err.find("TANDEM_PRELOAD names no config"), std::string::npos) << outcome.err;
  }
}

TEST(IgnitionHost, HasItsBoxPushedAlongASlotAsTheModelSays) {
  const TempFolder folder;
  const Outcome outcome =
      runPreloaded(TANDEM_IGNITION_HOST, inScene("free"), folder.write("slot.toml", R"(
object = "box 0.1 0.1 0.05"
mass = 0.2
bullet = "float"
guide = [1, 0, 0]
[contact]
damping = 20
[device]
start = [-0.06, 0, 0.025]
force = [0.5, 0, 0]
damping = 0
)"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("shares moving body 1 of world 1: box 0.1 0.1 0.05, 0.2 kg"),
            std::string::npos)
      << outcome.err;
  const std::vector<double> model = computePushed(0.5, 0.0);
  // At 0.2 m float positions are 1.5e-8 m apart, and Ignition's 1 ms is too long by a factor of
  // 5e-8.
  EXPECT_LT(compare(readRows(outcome.out), model), 1e-7);
  EXPECT_GT(model.back(), 0.2);
}

TEST(IgnitionHost, HasItsBoxPushedOverItsFloor) {
  const TempFolder folder;
  const Outcome outcome =
      runPreloaded(TANDEM_IGNITION_HOST, inScene("floor"), folder.write("floor.toml", R"(
object = 1
log = "floor.csv"
[contact]
damping = 20
[device]
start = [-0.06, 0, 0.025]
force = [5, 0, 0]
damping = 0
)"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Row> rows = readRows(outcome.out);
  // The friction of Ignition's floor is 1. Rigid contact is solved each 0.25 ms.
  EXPECT_LT(compare(rows, computePushed(5.0, kBoxMass * 9.81)), 1e-3);
  for (const Row& row : rows) EXPECT_NEAR(row.z, 0.025, 1e-5) << "at " << row.t;
  const std::string log = readFile(folder / "floor.csv");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 501);
}

// Boxes are inserted and removed before the pushed one, some in touch with it. Nothing falls
// through the floor, and nothing is thrown: without Tandem the box ends 0.47 m away. What the box
// does on a visitor's edge depends on the last digit of the force, so several are tried.
class VisitedIgnitionHost : public testing::TestWithParam<const char*> {};

TEST_P(VisitedIgnitionHost, HasBodiesThatComeAndGo) {
  const TempFolder folder;
  const std::string config = std::string(R"(
object = "box 0.1 0.1 0.05"
mass = 0.2
[contact]
damping = 20
[device]
start = [-0.06, 0, 0.025]
damping = 5
force = )") + "[" + GetParam() +
                             ", 0, 0]\n";
  const Outcome outcome = runPreloaded(TANDEM_IGNITION_HOST, inScene("visitors"),
                                       folder.write("visitors.toml", config));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("shares moving body 5 of world 1: box 0.1 0.1 0.05, 0.2 kg"),
            std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.err.find("no longer finite"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("world 1 ends after 500 steps with the object"), std::string::npos)
      << outcome.err;
  const std::vector<Row> rows = readRows(outcome.out);
  ASSERT_EQ(rows.size(), 9u);
  for (const Row& row : rows) {
    EXPECT_GT(row.z, 0.024) << "at " << row.t;
    EXPECT_LT(row.z, 0.08) << "at " << row.t;  // it may climb a visitor of 0.06 m
    EXPECT_LT(std::hypot(row.x, row.y), 0.25) << "at " << row.t;  // pushed aside, but not thrown
  }
  EXPECT_GT(rows[2].x, 5e-3);
}
INSTANTIATE_TEST_SUITE_P(Forces, VisitedIgnitionHost, testing::Values("5", "5.001", "5.01"));

}  // namespace
}  // namespace tandem::test
