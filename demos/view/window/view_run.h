#pragma once

#include <functional>
#include <memory>

#include "session/session_control.h"
#include "window/hand_look.h"
#include "window/panel.h"
#include "window/panel_window.h"

namespace tandem::view {

/// A window on a live session. The session begins before the window: Mesa's threads then get the
/// window's low priority, and haptic threads are not kept waiting.
class ViewRun {
 public:
  /// Throws as SessionControl and PanelWindow do.
  ViewRun(const ViewSettings& settings, const UsersDevices& devices);

  /// Until the user closes the window, `stop` asks to end or the time is over. Then stores the
  /// record, also before it throws what ended the session early, such as a friend with another
  /// scenario.
  void run(const std::function<bool()>& stop);

 private:
  void showFrame(double time);
  void showWorld();

  ViewSettings settings_;
  demos::LiveDevice* device_;  ///< null: the mouse
  SessionControl control_;
  std::filesystem::path seen_;  ///< file of the world that is shown
  HandLook hand_look_;
  std::unique_ptr<PanelWindow> window_;  ///< made once the thread has a low priority
  Panel panel_;
};

}  // namespace tandem::view
