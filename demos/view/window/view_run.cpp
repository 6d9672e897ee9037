#include "window/view_run.h"

#include <sys/resource.h>

#include "session/first_eye.h"

namespace tandem::view {
namespace {

/// The picture must not take time from the haptic threads.
void standBack() { setpriority(PRIO_PROCESS, 0, 19); }

}  // namespace

ViewRun::ViewRun(const ViewSettings& settings, const UsersDevices& devices)
    : settings_(settings),
      device_(devices.own),
      control_(settings.scenario, settings.line, devices, settings.record),
      seen_(settings.scenario.file),
      hand_look_(settings.scenario.site.proxy.radius) {
  standBack();
  window_ = std::make_unique<PanelWindow>(settings.window,
                                          chooseFirstEye(settings.scenario, userOf(settings.line)));
}

void ViewRun::run(const std::function<bool()>& stop) {
  try {
    window_->run([&] { return stop() || !control_.session().goesOn(); },
                 [&](double time) { showFrame(time); });
  } catch (...) {
    control_.end();
    throw;
  }
  control_.end();
}

void ViewRun::showFrame(double time) {
  Session& session = control_.session();
  MouseDevice* const mouse = control_.mouse();
  // The hand of a paused world waits for its user.
  const HandInput& input = window_->takeInput(control_.pace().is_paused ? nullptr : mouse, time);
  session.hold(device_ ? device_->isGripPressed() : input.wantsHold());
  session.showDetails(panel_.details());
  const auto look = session.look();
  DrawList list = look->list;
  hand_look_.add(list, mouse, look->hip_W, look->force_W);
  PanelWishes wishes;
  window_->draw(list, [&] {
    wishes = panel_.show(control_, *look);
    return wishes.takes_picture;
  });
  window_->note(control_.scenario(), control_.pace(), *look, time);
  control_.obey(wishes.session);
  if (control_.scenario().file != seen_) showWorld();
}

/// The hand and the eye belong to a world.
void ViewRun::showWorld() {
  const demos::Scenario& scenario = control_.scenario();
  seen_ = scenario.file;
  hand_look_ = HandLook(scenario.site.proxy.radius);
  window_->eye = chooseFirstEye(scenario, userOf(settings_.line));
}

}  // namespace tandem::view
