#pragma once

#include <functional>
#include <optional>

#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "scenario/scenario.h"
#include "window/gui.h"
#include "window/hand_input.h"
#include "window/status_file.h"
#include "window/view_settings.h"

namespace tandem::view {

/// A window with a panel over its picture. Live sessions and recorded runs are both shown in it.
class PanelWindow {
 public:
  /// Throws Error if there is no display or the status file cannot be written.
  PanelWindow(const WindowSettings& settings, const Eye& eye);

  /// Calls `show` at the time [s] of each frame, until the user closes the window, `stop` asks to
  /// end or the time is over. Then stores the last frame if that is wanted.
  void run(const std::function<bool()>& stop, const std::function<void(double)>& show);

  // In a frame:

  /// Takes the user's input, see HandInput::apply().
  const HandInput& takeInput(MouseDevice* mouse, double time);
  /// Draws the list and the panel over it. `show_panel` returns true if the user wants a picture.
  void draw(const DrawList& list, const std::function<bool()>& show_panel);
  /// Writes a line of the status file, if that is wanted and due.
  void note(const demos::Scenario& scenario, const Pace& pace, const SessionLook& look,
            double time);

  Eye eye;

 private:
  WindowSettings settings_;
  std::optional<StatusFile> status_;
  GlWindow window_;
  GlScene scene_;
  HandInput input_{window_.handle()};
  Gui gui_{window_.handle()};
  std::uint64_t frames_ = 0;
};

}  // namespace tandem::view
