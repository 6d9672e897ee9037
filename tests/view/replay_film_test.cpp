// The film of a recorded run.

#include <gtest/gtest.h>

#include "film/film_camera.h"
#include "gl/gl_context.h"
#include "replay/run_replay.h"
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
  FilmCamera camera(size, replay.scenario(), replay.user());
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

}  // namespace
}  // namespace tandem::view
