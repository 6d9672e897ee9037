#include "window/view_run.h"

#include <cstdio>

#include <fmt/format.h>
#include <sys/resource.h>

#include "tandem/falcon/monotonic_clock.h"

#include "gl/picture.h"
#include "session/first_eye.h"
#include "window/frame_pace.h"

namespace tandem::view {
namespace {

constexpr const char* kPictureName = "tandem-view.png";

/// The picture must not take time from the haptic threads.
void standBack() { setpriority(PRIO_PROCESS, 0, 19); }

}  // namespace

ViewRun::ViewRun(const ViewSettings& settings, demos::LiveDevice* device)
    : settings_(settings),
      device_(device),
      control_(settings.scenario, settings.line, device),
      hand_look_(settings.scenario.site.proxy.radius),
      eye_(chooseFirstEye(settings.scenario, userOf(settings))) {
  if (settings.status) status_.emplace(*settings.status);
  standBack();
  window_ = std::make_unique<GlWindow>("Tandem", settings.size);
  scene_ = std::make_unique<GlScene>();
  input_ = std::make_unique<HandInput>(window_->handle());
  gui_ = std::make_unique<Gui>(window_->handle());
}

void ViewRun::run(const std::function<bool()>& stop) {
  FramePace pace;
  const double begin = readMonotonicClock();
  for (;;) {
    const double now = pace.wait();
    if (stop() || !control_.session().goesOn() || !window_->isOpen()) break;
    if (settings_.duration && now - begin > *settings_.duration) break;
    if (!window_->size().isEmpty()) showFrame(now);
  }
  if (settings_.screenshot) storePicture(*settings_.screenshot);
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
  if (wishes.takes_picture) storePicture(kPictureName);
  window_->show();
  ++frames_;
  if (status_) status_->note(control_, *look, time, frames_);
  control_.obey(wishes.session);
}

void ViewRun::storePicture(const std::filesystem::path& file) const {
  if (const auto problem = writePng(readPicture(window_->size()), file))
    fmt::print(stderr, "tandem: {}\n", *problem);
}

}  // namespace tandem::view
