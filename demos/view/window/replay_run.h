#pragma once

#include <functional>

#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "replay/run_replay.h"
#include "window/gui.h"
#include "window/hand_input.h"
#include "window/hand_look.h"
#include "window/replay_panel.h"
#include "window/status_file.h"
#include "window/view_settings.h"

namespace tandem::view {

/// A window on a recorded run.
class ReplayRun {
 public:
  /// `replay` must outlive this. Throws Error if there is no display.
  ReplayRun(const WindowSettings& settings, RunReplay& replay);

  /// Until the user closes the window, `stop` asks to end or the time is over.
  void run(const std::function<bool()>& stop);

 private:
  void showFrame(double time);

  WindowSettings settings_;
  RunReplay& replay_;
  ReplayClock clock_;
  HandLook hand_look_;
  GlWindow window_;
  GlScene scene_;
  HandInput input_{window_.handle()};
  Gui gui_{window_.handle()};
  ReplayPanel panel_;
  Eye eye_;
  std::optional<StatusFile> status_;
  std::uint64_t frames_ = 0;
};

}  // namespace tandem::view
