#include "window/panel_window.h"

#include "window/frame_pace.h"
#include "window/store_picture.h"

namespace tandem::view {

PanelWindow::PanelWindow(const WindowSettings& settings, const Eye& first_eye)
    : eye(first_eye),
      settings_(settings),
      status_(settings.status ? std::make_optional<StatusFile>(*settings.status) : std::nullopt),
      window_("Tandem", settings.size) {}

void PanelWindow::run(const std::function<bool()>& stop, const std::function<void(double)>& show) {
  FramePace pace;
  const double begin = readMonotonicClock();
  for (;;) {
    const double now = pace.wait();
    if (stop() || !window_.isOpen()) break;
    if (settings_.duration && now - begin > *settings_.duration) break;
    if (!window_.size().isEmpty()) show(now);
  }
  if (settings_.screenshot) storePicture(window_.size(), *settings_.screenshot);
}

const HandInput& PanelWindow::takeInput(MouseDevice* mouse, double time) {
  input_.apply(mouse, eye, window_.size(), time, !gui_.hasPointer());
  return input_;
}

void PanelWindow::draw(const DrawList& list, const std::function<bool()>& show_panel) {
  const PictureSize size = window_.size();
  window_.bind();
  scene_.draw(list, eye, size);
  gui_.begin();
  const bool takes_picture = show_panel();
  gui_.draw();
  if (takes_picture) storePicture(size, kPictureName);
  window_.show();
  ++frames_;
}

void PanelWindow::note(const demos::Scenario& scenario, const Pace& pace, const SessionLook& look,
                       double time) {
  if (status_) status_->note(scenario, pace, look, time, frames_);
}

}  // namespace tandem::view
