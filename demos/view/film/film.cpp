#include "film/film.h"

#include "film/film_camera.h"
#include "film/frame_sink.h"
#include "gl/gl_context.h"
#include "replay/replay_eye.h"
#include "run/virtual_run.h"
#include "session/first_eye.h"
#include "session/scene_look.h"

namespace tandem::view {

void makeFilm(const demos::Scenario& scenario, const FilmSettings& settings,
              const std::function<void(double)>& progress) {
  const auto sink = makeFrameSink(settings.out, settings.size, demos::SceneRecord::kRate);
  const HeadlessContext context;
  demos::VirtualRun run(scenario);
  SceneLook look(run.world(0));
  FilmCamera camera(settings.size, scenario, chooseFirstEye(scenario, 0));
  const auto take = [&] {
    DrawList list = look.look();
    addGhosts(list, run.world(1));
    const Site& site = run.world(0).site();
    sink->add(camera.take(std::move(list), site.hip().p_W, site.force()));
  };
  take();
  run.run([&](double share) {
    take();
    progress(share);
  });
  sink->finish();
}

void makeFilm(RunReplay& replay, const FilmSettings& settings,
              const std::function<void(double)>& progress) {
  const auto sink = makeFrameSink(settings.out, settings.size, demos::SceneRecord::kRate);
  const HeadlessContext context;
  FilmCamera camera(settings.size, replay.scenario(), chooseReplayEye(replay, settings.size));
  for (const double time : replay.frames()) {
    SessionLook look = replay.look(time);
    sink->add(camera.take(std::move(look.list), look.hip_W, look.force_W));
    progress(time / replay.frames().back());
  }
  sink->finish();
}

}  // namespace tandem::view
