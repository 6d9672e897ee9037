// Rows of cubes pushed along a floor, and the order in which bodies are listed.

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "island/box_scene.h"

namespace tandem {
namespace {

using test::BoxScene;

constexpr double kHalf = 0.02;  // [m]
constexpr double kMass = 0.2;   // [kg]

/// A row of cubes along x. A spring pushes the first, as a tool at 50 mm/s.
class PushedRow {
 public:
  /// `order[i]` is the place in the row of body i. `sideways`: the tool goes aside, per way along.
  PushedRow(const std::vector<int>& order, double sideways)
      : sideways_(sideways), at_(order.size()) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      at_[static_cast<std::size_t>(order[i])] = static_cast<BodyIndex>(i);
      scene.add(Vec3::Constant(kHalf), kMass, Vec3(2.0 * kHalf * order[i], 0, kHalf));
    }
    for (std::size_t i = 1; i < at_.size(); ++i)
      scene.world.pairs.push_back({at_[i], at_[i - 1], 0});
    scene.world.friction = 0.3;
    CouplerSettings tool;
    tool.linear = {3000.0, 20.0};  // [N/m], [N s/m]
    tool_ = scene.island.addCoupler(at_[0], tool);
    scene.prepare();
  }
  explicit PushedRow(int count, double sideways = 0.0) : PushedRow(inOrder(count), sideways) {}

  static std::vector<int> inOrder(int count) {
    std::vector<int> order(static_cast<std::size_t>(count));
    std::iota(order.begin(), order.end(), 0);
    return order;
  }

  void run(double duration) {
    const auto ticks = static_cast<int>(std::lround(duration / scene.tick));
    for (int i = 0; i < ticks; ++i) {
      const double way = kSpeed * scene.tick * static_cast<double>(scene.ticks + 1);
      RigidState target;
      target.p_W = Vec3(way, sideways_ * way, kHalf);
      target.v_W = Vec3(kSpeed, sideways_ * kSpeed, 0);
      scene.island.setTarget(tool_, target);
      scene.advance();
    }
  }
  [[nodiscard]] const RigidState& cube(std::size_t place) const {
    return scene.island.state(at_[place]);
  }

  BoxScene scene;

 private:
  static constexpr double kSpeed = 0.05;  // [m/s]

  double sideways_;
  std::vector<BodyIndex> at_;
  CouplerIndex tool_ = 0;
};

// A factorisation costs as much per body in each row, so their number must not grow with the row:
// two a tick where modes flip, and more in the first ticks.
TEST(Rows, CostLinearlyWhenPushedStraight) {
  for (const int count : {1, 2, 4, 8, 16, 32}) {
    PushedRow row(count);
    row.run(0.5);
    EXPECT_LE(row.scene.factorisationsPerTick(), 4.0) << count << " cubes";
    EXPECT_LE(row.scene.stepsPerTick(), 1.1) << count << " cubes";
    EXPECT_LE(row.scene.most_factorisations, 80U) << count << " cubes";
    EXPECT_EQ(row.scene.relaxations, 0U) << count << " cubes";
    EXPECT_GT(row.cube(0).p_W.x(), 0.01) << count << " cubes";
    EXPECT_TRUE(row.scene.isFinite());
  }
}

// Free to yaw, friction between the cubes jams the row.
TEST(Rows, CostLinearlyWhenPushedAskew) {
  for (const int count : {1, 2, 4, 8}) {
    PushedRow row(count, 0.2);
    row.run(0.5);
    EXPECT_LE(row.scene.factorisationsPerTick(), 4.0) << count << " cubes";
    EXPECT_LE(row.scene.stepsPerTick(), 1.1) << count << " cubes";
    EXPECT_LE(row.scene.most_factorisations, 80U) << count << " cubes";
  }
}

// Rows stay in contact and move with the tool, not through each other.
TEST(Rows, StayTogether) {
  PushedRow row(8, 0.2);
  row.run(0.5);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_NEAR(row.cube(i).p_W.z(), kHalf, 1e-8);
    if (i > 0) {
      EXPECT_NEAR((row.cube(i).p_W - row.cube(i - 1).p_W).norm(), 2.0 * kHalf, 1e-7);
    }
  }
}

// Sums in another order differ by rounding, and the solver ends at 1e-9 m/s of each.
TEST(Rows, DoNotDependOnTheOrderOfBodies) {
  PushedRow row(6, 0.2), shuffled({3, 0, 5, 1, 4, 2}, 0.2);
  for (PushedRow* each : {&row, &shuffled}) each->run(0.3);
  for (std::size_t i = 0; i < 6; ++i) {
    const RigidState &a = row.cube(i), &b = shuffled.cube(i);
    EXPECT_LT((a.p_W - b.p_W).norm(), 1e-10) << "cube " << i;
    EXPECT_LT((a.q_WB.coeffs() - b.q_WB.coeffs()).norm(), 1e-8) << "cube " << i;
  }
}

TEST(Rows, RepeatToTheBit) {
  PushedRow first(6, 0.2), second(6, 0.2);
  for (PushedRow* each : {&first, &second}) each->run(0.3);
  for (std::size_t i = 0; i < 6; ++i) {
    const RigidState &a = first.cube(i), &b = second.cube(i);
    EXPECT_EQ(a.p_W, b.p_W);
    EXPECT_EQ(a.v_W, b.v_W);
    EXPECT_EQ(a.w_W, b.w_W);
    EXPECT_EQ(a.q_WB.coeffs(), b.q_WB.coeffs());
  }
  EXPECT_EQ(first.scene.factorisations, second.scene.factorisations);
}

}  // namespace
}  // namespace tandem
