#include "window/view_run.h"

#include <sys/resource.h>

#include "tandem/falcon/monotonic_clock.h"

#include "session/first_eye.h"
#include "window/frame_pace.h"
#include "window/store_picture.h"

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
      hand_look_(settings.scenario.site.proxy.radius),
      eye_(chooseFirstEye(settings.scenario, userOf(settings))) {
  if (settings.window.status) status_.emplace(*settings.window.status);
  standBack();
  window_ = std::make_unique<GlWindow>("Tandem", settings.window.size);
  scene_ = std::make_unique<GlScene>();
  input_ = std::make_unique<HandInput>(window_->handle());
  gui_ = std::make_unique<Gui>(window_->handle());
}

void ViewRun::run(const std::function<bool()>& stop) {
  try {
    showFrames(stop);
  } catch (...) {
    control_.end();
    throw;
  }
  control_.end();
}

void ViewRun::showFrames(const std::function<bool()>& stop) {
  FramePace pace;
  const double begin = readMonotonicClock();
  for (;;) {
    const double now = pace.wait();
    if (stop() || !control_.session().goesOn() || !window_->isOpen()) break;
    if (settings_.window.duration && now - begin > *settings_.window.duration) break;
    if (!window_->size().isEmpty()) showFrame(now);
  }
  if (settings_.window.screenshot) storePicture(window_->size(), *settings_.window.screenshot);
}

void ViewRun::showFrame(double time) {
  const PictureSize size = window_->size();
  Session& session = control_.session();
  MouseDevice* const mouse = control_.mouse();
  // The hand of a paused world waits for its user.
  input_->apply(control_.pace().is_paused ? nullptr : mouse, eye_, size, time, !gui_->hasPointer());
  session.hold(device_ ? device_->isGripPressed() : input_->wantsHold());
  session.showDetails(panel_.details());
  const auto look = session.look();
  DrawList list = look->list;
  hand_look_.add(list, mouse, look->hip_W, look->force_W);
  window_->bind();
  scene_->draw(list, eye_, size);
  gui_->begin();
  const PanelWishes wishes = panel_.show(control_, *look);
  gui_->draw();
  if (wishes.takes_picture) storePicture(size, kPictureName);
  window_->show();
  ++frames_;
  if (status_) status_->note(control_.scenario(), control_.pace(), *look, time, frames_);
  control_.obey(wishes.session);
  if (control_.scenario().file != seen_) showWorld();
}

/// The hand and the eye belong to a world.
void ViewRun::showWorld() {
  const demos::Scenario& scenario = control_.scenario();
  seen_ = scenario.file;
  hand_look_ = HandLook(scenario.site.proxy.radius);
  eye_ = chooseFirstEye(scenario, userOf(settings_));
}

}  // namespace tandem::view
