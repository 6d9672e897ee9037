#pragma once

#include <functional>
#include <memory>

#include "device/live_device.h"
#include "gl/gl_context.h"
#include "gl/gl_scene.h"
#include "session/live_session.h"
#include "session/peer_session.h"
#include "session/worker.h"
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
  /// `device` is the user's, and must outlive this; null: the mouse in the window. Throws Error if
  /// there is no display.
  ViewRun(const ViewSettings& settings, demos::LiveDevice* device);

  /// Until the user closes the window, `stop` asks to end or the time is over. Throws what ended
  /// the session early, such as a friend with another scenario.
  void run(const std::function<bool()>& stop);

 private:
  void startSession(bool goes_on);
  void makeSession(bool goes_on);
  void showFrame(double time);
  void obey(const PanelWishes& wishes);
  void storePicture(const std::filesystem::path& file) const;

  ViewSettings settings_;
  demos::Scenario scenario_;  ///< as the user has changed it
  demos::LiveDevice* device_;
  Worker session_maker_;
  std::unique_ptr<MouseDevice> mouse_;  ///< null with another device
  std::unique_ptr<Session> session_;
  LiveSession* both_ = nullptr;  ///< the session, if both sites are here
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
