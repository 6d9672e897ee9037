// Where a thing was between the states that a spectator was told.

#include "watch/motion_history.h"

#include <gtest/gtest.h>

namespace tandem::view {
namespace {

RigidState makeState(double x, double v) {
  RigidState state;
  state.p_W.x() = x;
  state.v_W.x() = v;
  return state;
}

TEST(MotionHistory, IsEmptyBeforeTheFirstState) { EXPECT_FALSE(MotionHistory().at(1.0)); }

// 3 m/s^2 from rest: a cubic with the right places and velocities is exact.
TEST(MotionHistory, FollowsAConstantAcceleration) {
  MotionHistory history;
  const auto x = [](double t) { return 1.5 * t * t; };
  for (const double t : {0.0, 0.03, 0.07, 0.1}) history.add(t, makeState(x(t), 3.0 * t));
  for (double t = 0.0; t <= 0.1; t += 0.003) EXPECT_NEAR(history.at(t)->p_W.x(), x(t), 1e-12) << t;
  EXPECT_EQ(history.at(-1.0)->p_W.x(), 0.0);
}

TEST(MotionHistory, TurnsEvenly) {
  MotionHistory history;
  RigidState state;
  history.add(0.0, state);
  state.q_WB = Quat(Eigen::AngleAxisd(0.4, Vec3::UnitZ()));
  history.add(0.1, state);
  const Quat half(Eigen::AngleAxisd(0.2, Vec3::UnitZ()));
  EXPECT_NEAR(history.at(0.05)->q_WB.angularDistance(half), 0.0, 1e-7);
}

TEST(MotionHistory, GoesOnForAWhileAfterTheNewestState) {
  MotionHistory history;
  RigidState state = makeState(1.0, 2.0);
  state.w_W.z() = 3.0;
  history.add(0.0, state);
  EXPECT_NEAR(history.at(0.01)->p_W.x(), 1.02, 1e-12);
  const RigidState end = *history.at(10.0);
  EXPECT_NEAR(end.p_W.x(), 1.0 + 2.0 * MotionHistory::kFarthest, 1e-12);
  const Quat turned(Eigen::AngleAxisd(3.0 * MotionHistory::kFarthest, Vec3::UnitZ()));
  EXPECT_NEAR(end.q_WB.angularDistance(turned), 0.0, 1e-7);
}

// A thing at rest is told rarely. It has not crept before it moved.
TEST(MotionHistory, StaysForTheBeginningOfALongGap) {
  MotionHistory history;
  history.add(0.0, makeState(0.0, 0.0));
  history.add(1.0, makeState(0.01, 0.0));
  EXPECT_EQ(history.at(1.0 - MotionHistory::kLongest)->p_W.x(), 0.0);
  EXPECT_EQ(history.at(0.5)->p_W.x(), 0.0);
  EXPECT_NEAR(history.at(1.0 - 0.5 * MotionHistory::kLongest)->p_W.x(), 0.005, 1e-12);
}

TEST(MotionHistory, JumpsFromOneEpochToTheNext) {
  MotionHistory history;
  history.add(0.0, makeState(0.0, 0.0), {1, PeerId{1}});
  history.add(0.03, makeState(1.0, 0.0), {2, PeerId{1}});
  EXPECT_EQ(history.at(0.029)->p_W.x(), 0.0);
  EXPECT_EQ(history.at(0.03)->p_W.x(), 1.0);
}

TEST(MotionHistory, ForgetsWhatWasLongAgo) {
  MotionHistory history;
  for (int i = 0; i < 100; ++i) history.add(0.03 * i, makeState(i, 0.0));
  EXPECT_EQ(history.at(0.03 * 99)->p_W.x(), 99.0);
  EXPECT_EQ(history.at(0.0)->p_W.x(), 92.0);
}

}  // namespace
}  // namespace tandem::view
