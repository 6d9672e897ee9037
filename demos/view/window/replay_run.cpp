#include "window/replay_run.h"

#include "replay/replay_eye.h"
#include "window/frame_pace.h"
#include "window/store_picture.h"

namespace tandem::view {

ReplayRun::ReplayRun(const WindowSettings& settings, RunReplay& replay)
    : settings_(settings),
      replay_(replay),
      clock_(replay.frames(), replay.duration()),
      hand_look_(replay.scenario().site.proxy.radius),
      window_("Tandem", settings.size),
      eye_(chooseReplayEye(replay, settings.size)) {
  if (settings.status) status_.emplace(*settings.status);
}

void ReplayRun::run(const std::function<bool()>& stop) {
  FramePace pace;
  const double begin = readMonotonicClock();
  double last = begin;
  for (;;) {
    const double now = pace.wait();
    if (stop() || !window_.isOpen()) break;
    if (settings_.duration && now - begin > *settings_.duration) break;
    clock_.advance(now - last);
    last = now;
    if (!window_.size().isEmpty()) showFrame(now);
  }
  if (settings_.screenshot) storePicture(window_.size(), *settings_.screenshot);
}

void ReplayRun::showFrame(double time) {
  const PictureSize size = window_.size();
  input_.apply(nullptr, eye_, size, time, !gui_.hasPointer());
  SessionLook look = replay_.look(clock_.time());
  hand_look_.add(look.list, nullptr, look.hip_W, look.force_W);
  window_.bind();
  scene_.draw(look.list, eye_, size);
  gui_.begin();
  const bool takes_picture = panel_.show(replay_.scenario(), look, clock_);
  gui_.draw();
  if (takes_picture) storePicture(size, kPictureName);
  window_.show();
  ++frames_;
  const Pace pace{clock_.speed, !clock_.isPlaying()};
  if (status_) status_->note(replay_.scenario(), pace, look, time, frames_);
}

}  // namespace tandem::view
