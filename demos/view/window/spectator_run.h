#pragma once

#include <functional>

#include "watch/watch_session.h"
#include "window/panel_window.h"
#include "window/spectator_panel.h"

namespace tandem::view {

/// A window on the session of others, without a hand.
class SpectatorRun {
 public:
  /// Throws as WatchSession and PanelWindow do.
  SpectatorRun(const WindowSettings& settings, const demos::Scenario& scenario,
               const demos::PeerLine& line);

  /// Until the user closes the window, `stop` asks to end or the time is over. Throws what ended
  /// the session, such as a site with another scenario.
  void run(const std::function<bool()>& stop);

 private:
  void showFrame(double time);

  demos::Scenario scenario_;
  WatchSession session_;
  PanelWindow window_;
  SpectatorPanel panel_;
};

}  // namespace tandem::view
