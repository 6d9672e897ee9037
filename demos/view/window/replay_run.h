#pragma once

#include <functional>

#include "replay/run_replay.h"
#include "window/hand_look.h"
#include "window/panel_window.h"
#include "window/replay_panel.h"

namespace tandem::view {

/// A window on a recorded run.
class ReplayRun {
 public:
  /// `replay` must outlive this. Throws as PanelWindow does.
  ReplayRun(const WindowSettings& settings, RunReplay& replay);

  /// Until the user closes the window, `stop` asks to end or the time is over.
  void run(const std::function<bool()>& stop);

 private:
  void showFrame(double time);

  RunReplay& replay_;
  ReplayClock clock_;
  HandLook hand_look_;
  PanelWindow window_;
  ReplayPanel panel_;
};

}  // namespace tandem::view
