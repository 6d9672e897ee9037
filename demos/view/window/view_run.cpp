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
      scenario_(settings.scenario),
      device_(device),
      hand_look_(scenario_.site.proxy.radius),
      eye_(chooseFirstEye(scenario_, userOf(settings))) {
  if (settings.status) status_.emplace(*settings.status);
  startSession(false);
  standBack();
  window_ = std::make_unique<GlWindow>("Tandem", settings.size);
  scene_ = std::make_unique<GlScene>();
  input_ = std::make_unique<HandInput>(window_->handle());
  gui_ = std::make_unique<Gui>(window_->handle());
}

void ViewRun::startSession(bool goes_on) {
  session_maker_.run([&] { makeSession(goes_on); });
}

/// A session that goes on has hands and bodies where they were.
void ViewRun::makeSession(bool goes_on) {
  demos::Scenario scenario = scenario_;
  SessionPlaces places;
  if (goes_on) {
    places = both_->end();
    startHandsAt(places, scenario);
  }
  session_.reset();
  if (!device_) {
    MouseSettings settings;
    settings.start_W =
        demos::computeStart(scenario, demos::makeSceneFrame(scenario), userOf(settings_));
    mouse_ = std::make_unique<MouseDevice>(settings);
  }
  HapticDevice& device = device_ ? static_cast<HapticDevice&>(*device_) : *mouse_;
  if (settings_.line) {
    session_ = std::make_unique<PeerSession>(scenario, *settings_.line, device);
    return;
  }
  auto session = std::make_unique<LiveSession>(scenario, device, places.bodies);
  both_ = session.get();
  session_ = std::move(session);
}

void ViewRun::run(const std::function<bool()>& stop) {
  FramePace pace;
  const double begin = readMonotonicClock();
  for (;;) {
    const double now = pace.wait();
    if (stop() || !session_->goesOn() || !window_->isOpen()) break;
    if (settings_.duration && now - begin > *settings_.duration) break;
    if (!window_->size().isEmpty()) showFrame(now);
  }
  if (settings_.screenshot) storePicture(*settings_.screenshot);
}

void ViewRun::showFrame(double time) {
  const PictureSize size = window_->size();
  input_->apply(mouse_.get(), eye_, size, time, !gui_->hasPointer());
  session_->hold(device_ ? device_->isGripPressed() : input_->wantsHold());
  const auto look = session_->look();
  DrawList list = look->list;
  hand_look_.add(list, mouse_.get(), look->hip_W, look->force_W);
  window_->bind();
  scene_->draw(list, eye_, size);
  gui_->begin();
  const PanelWishes wishes = panel_.show(scenario_, *look, session_->notes(), both_ != nullptr);
  gui_->draw();
  if (wishes.takes_picture) storePicture(kPictureName);
  window_->show();
  ++frames_;
  if (status_) status_->note(scenario_, *look, time, frames_);
  obey(wishes);
}

void ViewRun::obey(const PanelWishes& wishes) {
  session_->showDetails(panel_.details());
  if (!both_) return;
  if (wishes.restarts || wishes.changes_scheme)
    startSession(!wishes.restarts);
  else if (wishes.changes_network)
    both_->setNetwork(scenario_.network);
}

void ViewRun::storePicture(const std::filesystem::path& file) const {
  if (const auto problem = writePng(readPicture(window_->size()), file))
    fmt::print(stderr, "tandem: {}\n", *problem);
}

}  // namespace tandem::view
