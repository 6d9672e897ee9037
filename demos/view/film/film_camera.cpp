#include "film/film_camera.h"

#include "session/scene_look.h"

namespace tandem::view {
namespace {

constexpr int kSamples = 4;  // for each pixel

}  // namespace

FilmCamera::FilmCamera(PictureSize size, const demos::Scenario& scenario, const Eye& eye)
    : target_(size, kSamples), ball_(makeBall(scenario.site.proxy.radius)), eye_(eye) {}

Picture FilmCamera::take(DrawList list, const Vec3& hip_W, const Vec3& force_W) {
  addHand(list, ball_, hip_W, force_W, kOwnColour);
  target_.bind();
  scene_.draw(list, eye_, target_.size());
  target_.bindForReading();
  return readPicture(target_.size());
}

}  // namespace tandem::view
