#include "film/film.h"

#include "film/film_camera.h"
#include "film/frame_sink.h"
#include "gl/gl_context.h"
#include "replay/replay_eye.h"
#include "run/virtual_run.h"
#include "session/first_eye.h"
#include "session/scene_look.h"

namespace tandem::view {
namespace {

/// Chooses pictures for a film from more that there might be.
class FramePicker {
 public:
  explicit FramePicker(double rate) : rate_(rate) {}
  /// True if it is time for the next picture at `time` [s], which is then counted as taken.
  [[nodiscard]] bool isDue(double time) {
    // Moments are counted, not summed; the slack covers their rounding.
    if (time * rate_ < count_ - 1e-9) return false;
    ++count_;
    return true;
  }

 private:
  double rate_;
  double count_ = 0.0;
};

}  // namespace

void makeFilm(const demos::Scenario& scenario, const FilmSettings& settings,
              const std::function<void(double)>& progress) {
  const auto sink = makeFrameSink(settings.out, settings.size, settings.rate);
  const HeadlessContext context;
  demos::VirtualRun run(scenario);
  SceneLook look(run.world(0));
  FilmCamera camera(settings.size, scenario, chooseFirstEye(scenario, 0));
  const auto take = [&] {
    DrawList list = look.look();
    for (int other = 1; other < run.siteCount(); ++other) addGhosts(list, run.world(other));
    const Site& site = run.world(0).site();
    sink->add(camera.take(std::move(list), site.hip().p_W, site.force()));
  };
  FramePicker picker(settings.rate);
  if (picker.isDue(0.0)) take();
  run.run([&](double share) {
    if (picker.isDue(share * scenario.duration)) take();
    progress(share);
  });
  sink->finish();
}

void makeFilm(RunReplay& replay, const FilmSettings& settings,
              const std::function<void(double)>& progress) {
  const auto sink = makeFrameSink(settings.out, settings.size, settings.rate);
  const HeadlessContext context;
  FilmCamera camera(settings.size, replay.scenario(), chooseReplayEye(replay, settings.size));
  FramePicker picker(settings.rate);
  for (const double time : replay.frames()) {
    if (!picker.isDue(time)) continue;
    SessionLook look = replay.look(time);
    sink->add(camera.take(std::move(look.list), look.hip_W, look.force_W));
    progress(time / replay.frames().back());
  }
  sink->finish();
}

}  // namespace tandem::view
