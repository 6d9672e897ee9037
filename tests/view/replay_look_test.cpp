// A recorded run looks as it did while it ran.

#include <algorithm>

#include <gtest/gtest.h>

#include "tandem/plugin/site.h"

#include "replay/run_replay.h"
#include "scene/draw_text.h"
#include "view/run_rig.h"

namespace tandem::view {
namespace {

/// Poses are written with seven digits.
constexpr double kRounding = 1e-7;  // [m]

class ReplayLook : public test::RunRig {
 protected:
  void expectAsItEnded(int user) {
    RunReplay replay(loadRecordedRun(folder), user);
    const SessionLook look = replay.look(replay.duration());
    SceneLook scene_look(run->world(user));
    DrawList list = scene_look.look();
    const double apart = addGhosts(list, run->world(1 - user));
    EXPECT_NEAR(look.apart, apart, kRounding);
    ASSERT_EQ(look.list.solids.size(), list.solids.size());
    for (std::size_t i = 0; i < list.solids.size(); ++i) {
      EXPECT_EQ(look.list.solids[i].name, list.solids[i].name);
      EXPECT_LT((look.list.solids[i].p_WB - list.solids[i].p_WB).norm(), kRounding);
      EXPECT_LT(look.list.solids[i].q_WB.angularDistance(list.solids[i].q_WB), 1e-6);
    }
  }
};

TEST_F(ReplayLook, IsThatOfTheRunAtItsEnd) {
  for (int user : {0, 1}) expectAsItEnded(user);
}

TEST_F(ReplayLook, HasTheHandAndTheForceOfEachTick) {
  double most = 0.0;
  for (int user : {0, 1}) {
    RunReplay replay(loadRecordedRun(folder), user);
    for (const TickRecord& tick : run->recording(user).ticks()) {
      const SessionLook look = replay.look(tick.time);
      EXPECT_LT((look.hip_W - tick.device.hip.p_W).norm(), kRounding) << tick.time;
      EXPECT_LT((look.force_W - tick.f_W).norm(), 1e-12) << tick.time;
      most = std::max(most, look.force_W.norm());
    }
  }
  EXPECT_GT(most, 0.1) << "nothing was felt";
}

TEST_F(ReplayLook, IsStraightBetweenTwoFrames) {
  RunReplay replay(loadRecordedRun(folder), 0);
  const std::vector<double> frames = replay.frames();
  const double begin = frames[frames.size() - 2], end = frames.back();
  const Vec3 from_W = replay.look(begin).object_W, to_W = replay.look(end).object_W;
  ASSERT_GT((to_W - from_W).norm(), 1e-4) << "the cube does not move";
  const Vec3 half_W = replay.look(0.5 * (begin + end)).object_W;
  EXPECT_LT((half_W - 0.5 * (from_W + to_W)).norm(), 1e-12);
  EXPECT_EQ(writeDrawList(replay.look(-1.0).list), writeDrawList(replay.look(0.0).list));
  EXPECT_EQ(writeDrawList(replay.look(9.0).list), writeDrawList(replay.look(end).list));
}

TEST(RecordedPose, TurnsTheShortWay) {
  RecordedScene scene;
  scene.names = {"a"};
  scene.times = {0.0, 1.0};
  const Quat turned(Eigen::AngleAxisd(0.2, Vec3::UnitZ()));
  scene.poses = {{Vec3::Zero(), Quat::Identity()},
                 {Vec3::UnitX(), Quat(-turned.w(), 0.0, 0.0, -turned.z())}};
  const RecordedPose half = computePose(scene, 0, 0.25);
  EXPECT_NEAR(half.q_SB.angularDistance(Quat::Identity()), 0.05, 1e-12);
  EXPECT_NEAR(half.p_S.x(), 0.25, 1e-12);
}

}  // namespace
}  // namespace tandem::view
