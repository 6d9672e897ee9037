#pragma once

#include <functional>
#include <memory>

#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "session/session_control.h"
#include "window/gui.h"
#include "window/hand_input.h"
#include "window/hand_look.h"
#include "window/panel.h"
#include "window/status_file.h"
#include "window/view_settings.h"

namespace tandem::view {

/// A window on a live session. The session begins before the window: Mesa's threads then get the
/// window's low priority, and haptic threads are not kept waiting.
class ViewRun {
 public:
  /// Throws Error if there is no display, and as SessionControl does.
  ViewRun(const ViewSettings& settings, const UsersDevices& devices);

  /// Until the user closes the window, `stop` asks to end or the time is over. Then stores the
  /// record, also before it throws what ended the session early, such as a friend with another
  /// scenario.
  void run(const std::function<bool()>& stop);

 private:
  void showFrames(const std::function<bool()>& stop);
  void showFrame(double time);
  void showWorld();

  ViewSettings settings_;
  demos::LiveDevice* device_;  ///< null: the mouse
  SessionControl control_;
  std::filesystem::path seen_;  ///< file of the world that is shown
  HandLook hand_look_;
  std::unique_ptr<GlWindow> window_;
  std::unique_ptr<GlScene> scene_;
  std::unique_ptr<HandInput> input_;
  std::unique_ptr<Gui> gui_;
  Panel panel_;
  Eye eye_;
  std::optional<StatusFile> status_;
  std::uint64_t frames_ = 0;
};

}  // namespace tandem::view
