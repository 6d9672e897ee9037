// The film of a recorded run.

#include <gtest/gtest.h>

#include "film/film_camera.h"
#include "gl/gl_context.h"
#include "replay/replay_eye.h"
#include "session/first_eye.h"
#include "view/picture_rig.h"
#include "view/run_rig.h"

namespace tandem::view {
namespace {

using ReplayFilm = test::RunRig;

/// The rounding of poses moves edges by far less than a pixel.
TEST_F(ReplayFilm, HasThePicturesOfTheWorldsFilm) {
  const PictureSize size{320, 200};
  const HeadlessContext context;
  RunReplay replay(loadRecordedRun(folder), 0);
  FilmCamera camera(size, replay.scenario(), chooseReplayEye(replay, size));
  const Site& site = run->world(0).site();
  SceneLook scene_look(run->world(0));
  DrawList list = scene_look.look();
  addGhosts(list, run->world(1));
  const Picture of_run = camera.take(list, site.hip().p_W, site.force());
  const SessionLook look = replay.look(replay.duration());
  const Picture of_replay = camera.take(look.list, look.hip_W, look.force_W);
  EXPECT_LT(test::countChanged(of_run, of_replay), 320 * 200 / 100);
  const SessionLook first = replay.look(0.0);
  const Picture of_begin = camera.take(first.list, first.hip_W, first.force_W);
  EXPECT_GT(test::countChanged(of_run, of_begin), 320 * 200 / 50);
}

TEST_F(ReplayFilm, IsSeenAsTheWorldIsIfThatShowsAll) {
  RunReplay replay(loadRecordedRun(folder), 1);
  const Eye usual = chooseFirstEye(replay.scenario(), 1);
  const Eye eye = chooseReplayEye(replay, {960, 600});
  EXPECT_EQ(eye.target_W, usual.target_W);
  EXPECT_EQ(eye.distance, usual.distance);
}

TEST(ReplayEye, StepsBackUntilAllIsInThePicture) {
  const Eye eye;
  const PictureSize size{960, 600};
  const std::vector<Vec3> far = {Vec3(-2.0, 0.0, 0.0), Vec3(3.0, 1.0, 0.0), Vec3(0.0, 0.0, 0.5)};
  const Eye found = showAll(eye, size, far);
  EXPECT_EQ(found.azimuth, eye.azimuth);
  EXPECT_EQ(found.elevation, eye.elevation);
  EXPECT_GT(found.distance, eye.distance);
  for (const Vec3& p_W : far) {
    const auto seen = projectPoint(found, size, p_W);
    ASSERT_TRUE(seen);
    EXPECT_GE(seen->point.x, 0.05 * 960);
    EXPECT_LE(seen->point.x, 0.95 * 960);
    EXPECT_GE(seen->point.y, 0.05 * 600);
    EXPECT_LE(seen->point.y, 0.95 * 600);
  }
  // No farther than it must.
  Eye nearer = found;
  nearer.distance /= 1.2;
  bool shows = true;
  for (const Vec3& p_W : far) {
    const auto seen = projectPoint(nearer, size, p_W);
    shows &= seen && seen->point.x >= 0.05 * 960 && seen->point.x <= 0.95 * 960;
  }
  EXPECT_FALSE(shows);
}

}  // namespace
}  // namespace tandem::view
