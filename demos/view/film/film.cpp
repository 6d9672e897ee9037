#include "film/film.h"

#include "film/frame_sink.h"
#include "gl/frame_target.h"
#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "run/virtual_run.h"
#include "session/first_eye.h"
#include "session/scene_look.h"

namespace tandem::view {
namespace {

/// VirtualRun calls back as often for each simulated second [Hz].
constexpr double kFrameRate = 30.0;
constexpr int kSamples = 4;  // for each pixel

/// Draws the world of site 1 with both hands.
class Camera {
 public:
  Camera(const FilmSettings& settings, const demos::Scenario& scenario, demos::VirtualRun& run)
      : run_(run),
        look_(run.world(0)),
        target_(settings.size, kSamples),
        ball_(makeBall(scenario.site.proxy.radius)),
        eye_(chooseFirstEye(scenario, 0)) {}

  [[nodiscard]] Picture take() {
    DrawList list = look_.look();
    addGhosts(list, run_.world(1));
    const Site& site = run_.world(0).site();
    addHand(list, ball_, site.hip().p_W, site.force(), kOwnColour);
    target_.bind();
    scene_.draw(list, eye_, target_.size());
    target_.bindForReading();
    return readPicture(target_.size());
  }

 private:
  demos::VirtualRun& run_;
  SceneLook look_;
  GlScene scene_{Quality::kStill};
  FrameTarget target_;
  std::shared_ptr<const ShapeMesh> ball_;
  Eye eye_;
};

}  // namespace

void makeFilm(const FilmSettings& settings, const std::function<void(double)>& progress) {
  const demos::Scenario scenario = demos::loadScenario(settings.scenario, settings.overrides);
  const auto sink = makeFrameSink(settings.out, settings.size, kFrameRate);
  const HeadlessContext context;
  demos::VirtualRun run(scenario);
  Camera camera(settings, scenario, run);
  sink->add(camera.take());
  run.run([&](double share) {
    sink->add(camera.take());
    progress(share);
  });
  sink->finish();
}

}  // namespace tandem::view
