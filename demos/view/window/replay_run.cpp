#include "window/replay_run.h"

#include "tandem/falcon/monotonic_clock.h"

#include "replay/replay_eye.h"

namespace tandem::view {

ReplayRun::ReplayRun(const WindowSettings& settings, RunReplay& replay)
    : replay_(replay),
      clock_(replay.frames(), replay.duration()),
      hand_look_(replay.scenario().site.proxy.radius),
      window_(settings, chooseReplayEye(replay, settings.size)) {}

void ReplayRun::run(const std::function<bool()>& stop) {
  double last = readMonotonicClock();
  window_.run(stop, [&](double now) {
    clock_.advance(now - last);
    last = now;
    showFrame(now);
  });
}

void ReplayRun::showFrame(double time) {
  window_.takeInput(nullptr, time);
  SessionLook look = replay_.look(clock_.time());
  hand_look_.add(look.list, nullptr, look.hip_W, look.force_W);
  window_.draw(look.list, [&] { return panel_.show(replay_.scenario(), look, clock_); });
  const Pace pace{clock_.speed, !clock_.isPlaying()};
  window_.note(replay_.scenario(), pace, look, time);
}

}  // namespace tandem::view
