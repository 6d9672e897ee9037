#include "window/spectator_run.h"

#include "replay/replay_eye.h"
#include "session/first_eye.h"
#include "window/panel_parts.h"

namespace tandem::view {
namespace {

/// Hands and the first object.
std::vector<Vec3> listPlaces(const SessionLook& look) {
  std::vector<Vec3> places_W = {look.object_W};
  for (const UserLook& one : look.users)
    if (!one.has_another_scenario) places_W.push_back(one.hand_W);
  return places_W;
}

/// Near enough for what the scenario says, and all hands in the picture.
Eye chooseSpectatorEye(const demos::Scenario& scenario, PictureSize size) {
  const demos::SceneFrame frame = demos::makeSceneFrame(scenario);
  std::vector<Vec3> starts_W;
  for (int user = 0; user < static_cast<int>(scenario.sites.size()); ++user)
    starts_W.push_back(demos::computeStart(scenario, frame, user));
  return showAll(chooseFirstEye(scenario, 0), size, starts_W);
}

}  // namespace

SpectatorRun::SpectatorRun(const WindowSettings& settings, const demos::Scenario& scenario,
                           const demos::PeerLine& line)
    : scenario_(scenario),
      session_(scenario, line),
      window_(settings, chooseSpectatorEye(scenario, settings.size)) {}

void SpectatorRun::run(const std::function<bool()>& stop) {
  window_.run([&] { return stop() || !session_.goesOn(); }, [&](double time) { showFrame(time); });
}

void SpectatorRun::showFrame(double time) {
  window_.takeInput(nullptr, time);
  session_.showDetails(panel_.details());
  const auto look = session_.look();
  SpectatorWishes wishes;
  window_.draw(look->list, [&] {
    labelHands(*look, window_.eye);
    wishes = panel_.show(scenario_, *look, session_.notes());
    if (wishes.shows_all) window_.eye = showAll(window_.eye, shownSize(), listPlaces(*look));
    return wishes.takes_picture;
  });
  window_.note(scenario_, {}, *look, time);
  if (wishes.followed) session_.follow(*wishes.followed);
}

}  // namespace tandem::view
